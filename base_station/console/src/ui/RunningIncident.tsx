import { useSignal } from "@preact/signals";
import * as api from "../api";
import { rich, t } from "../language/translate";
import { unfinished } from "../live/closing";
import type { Picture } from "../live/picture";
import { attempt, live } from "../sessions";
import type { IncidentView } from "../wire";
import { AssignForm } from "./AssignForm";
import { ConfirmButton } from "./ConfirmButton";
import { useDone } from "./Done";
import { OpenIncidentForm } from "./OpenIncidentForm";
import { showIncident } from "./showIncident";
import { TimesFields, timesOf } from "./TimesFields";
import { fields } from "./useLoaded";

interface Props {
  running: IncidentView;
  done: () => void;
}

/** The incident that is open: it is closed, its times are changed, and another is opened beside it. */
export function RunningIncident({ running, done }: Props) {
  return (
    <>
      <p class="row said">
        <span>{rich("incident.is_open", { incident: <strong>{running.name}</strong> })}</span>
        <CloseButton incident={running} done={done} />
      </p>
      <TimesForm key={running.incident_id} incident={running} />
      {live.value !== null && (
        <SeveralIncidents running={running} picture={live.value.picture} done={done} />
      )}
    </>
  );
}

/** With open alarms or people inside, only by naming them. */
function CloseButton({ incident, done }: { incident: IncidentView; done: () => void }) {
  const picture = live.value?.picture;
  if (picture === undefined) return null;
  void picture.unitsChanged.value;
  const members = picture.allUnits();
  const alarms = [...picture.alarms.value.values()].filter(({ unit_id }) => picture.isShown(unit_id));
  const { words, ...despite } = unfinished(members, alarms);
  return (
    <ConfirmButton
      label={t("incident.close")}
      question={
        words === "" ? t("incident.close_question") : t("incident.close_over", { unfinished: words })
      }
      onConfirm={() => void attempt(api.closeIncident(incident.incident_id, despite)).then(done)}
    />
  );
}

/** Crews for the incident that is shown, and another incident beside it. */
function SeveralIncidents({ running, picture, done }: SeveralProps) {
  const isAsked = useSignal(false);
  const several = picture.choices.value.length > 0;
  const opened = (incident: api.Incident | null) => {
    if (incident === null) return;
    isAsked.value = false;
    showIncident(picture, incident.incident_id);
    done();
  };
  return (
    <>
      {several && <AssignForm key={running.incident_id} incident={running} picture={picture} />}
      <p class="row">
        <button
          type="button"
          aria-expanded={isAsked.value}
          onClick={() => (isAsked.value = !isAsked.value)}
        >
          {t("incident.open_another")}
        </button>
      </p>
      {isAsked.value && (
        <>
          <p>{rich("incident.goes_on", { incident: <strong>{running.name}</strong> })}</p>
          <OpenIncidentForm beside done={opened} />
        </>
      )}
    </>
  );
}

interface SeveralProps extends Props {
  picture: Picture;
}

/** Change of the times during an incident. */
function TimesForm({ incident }: { incident: IncidentView }) {
  const done = useDone(t("incident.times_changed"));
  return (
    <form
      class="row"
      onInput={done.unsay}
      onSubmit={(event) => {
        const changed = api.setTimes(incident.incident_id, timesOf(fields(event)));
        void attempt(changed.then(done.say));
      }}
    >
      <TimesFields times={incident} />
      <button>{t("incident.change_times")}</button>
      {done.words}
    </form>
  );
}
