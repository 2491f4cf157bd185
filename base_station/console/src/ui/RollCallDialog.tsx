import { attempt, mayAct, picture as shown } from "../sessions";
import { openDialog } from "../uiState";
import * as api from "../api";
import { needsOf } from "../live/alarms";
import { confirmationWords, crewsOnDuty, type CrewOnDuty, type OnDuty } from "../live/duty";
import { displayName } from "../live/urgency";
import { confirmPar } from "../undo";
import type { DutyView, UnitView } from "../wire";
import { alarmLabel, minutes } from "../format";
import { listed } from "../language/measures";
import { t } from "../language/translate";
import { ByRadio } from "./ByRadio";
import { ConfirmButton } from "./ConfirmButton";
import { Dialog } from "./Dialog";
import { useGuardedPress } from "./useGuardedPress";
import { Icon } from "./Icon";
import { ParMark } from "./ParClock";

/** PAR of each member: by own unit, by radio, or not yet; one press enters an answer by radio. */
export function RollCallDialog() {
  const picture = shown.value;
  if (picture === null) return null;
  void picture.unitsChanged.value;
  const incident = picture.incident.value;
  const crews = crewsOnDuty(picture.allUnits(), incident, picture.nowMs.value);
  return (
    <Dialog title={t("par.title")} wide>
      {crews.length === 0 && (
        <p>{t("par.nobody")}</p>
      )}
      {mayAct.value && crews.length > 0 && (
        <p class="row roll-all">
          <span>{t("par.hint")}</span>
          <button type="button" onClick={() => openDialog("par_request")}>
            {t("par.send")}
          </button>
          <ByRadio
            label={t("par.confirm_all")}
            members={unitsIn(crews)}
            question={t("par.everybody_question")}
            always
            onConfirm={() => void confirmPar({ everyone: true }, t("par.everybody"))}
          />
        </p>
      )}
      {crews.map((crew, i) => (
        <Crew key={crew.crew} crew={crew} place={peopleIn(crews.slice(0, i))} picture={picture} />
      ))}
    </Dialog>
  );
}

type Shown = NonNullable<(typeof shown)["value"]>;

interface CrewProps {
  crew: CrewOnDuty;
  place: number; // how many people stand above
  picture: Shown;
}

function Crew({ crew, place, picture }: CrewProps) {
  const steady = useGuardedPress(place);
  const name = crew.crew === "" ? t("par.no_crew") : crew.crew;
  const all = () => void confirmPar({ crew: crew.crew }, name);
  return (
    <section class={`roll-crew ${crew.par.state}`} aria-label={name}>
      <header>
        <h3>
          {name} <span class="quiet">{t("par.on_duty", { count: crew.people.length })}</span>
        </h3>
        {mayAct.value && crew.crew !== "" && crew.people.length > 1 && (
          <ByRadio
            label={t("par.crew_confirm_all", { crew: name })}
            members={unitsIn([crew])}
            question={t("par.all_question")}
            onConfirm={steady(all)}
          />
        )}
      </header>
      <ul>
        {crew.people.map((one, i) => (
          <Row key={one.unit.unit_id} one={one} place={place + i} picture={picture} />
        ))}
      </ul>
    </section>
  );
}

function Row({ one, place, picture }: { one: OnDuty; place: number; picture: Shown }) {
  const steady = useGuardedPress(place);
  const { unit, duty } = one;
  const needs = needsOf(unit, picture.alarms.value);
  const name = displayName(unit);
  return (
    <li class={one.par.state}>
      <span class="roll-name">
        <strong>{name}</strong>
        {needs.length > 0 && (
          <span class="in-need">
            <Icon name="alarm" />
            {listed(needs.map(alarmLabel))}
          </span>
        )}
      </span>
      <ParMark unit={unit} picture={picture} brief />
      <span class="quiet roll-words">
        {listed(dutyWords(duty, picture.nowMs.value))}
      </span>
      {mayAct.value && (
        <span class="roll-acts">
          {duty.entry_id !== "" && (
            <ConfirmButton
              label={t("par.undo")}
              about={t("par.undo_about", { name })}
              question={t("par.undo_question", { name })}
              onConfirm={() => void attempt(api.undoCheckIn(duty.entry_id, unit.unit_id))}
            />
          )}
          <ByRadio
            label={t("par.confirm")}
            about={name}
            members={[unit]}
            question={t("par.question", { name })}
            kind="primary tick"
            onConfirm={steady(() => void confirmPar({ unit_id: unit.unit_id }, name))}
          />
        </span>
      )}
    </li>
  );
}

function dutyWords(duty: DutyView, nowMs: number): string[] {
  const words = [confirmationWords(duty)];
  if (!duty.located) words.push(t("par.not_located"));
  if (duty.rest_since_ms !== null) words.push(t("par.rehab_for", { time: minutes(nowMs - duty.rest_since_ms) }));
  if (duty.work_since_ms !== null) words.push(t("par.work_for", { time: minutes(nowMs - duty.work_since_ms) }));
  return words;
}

function unitsIn(crews: readonly CrewOnDuty[]): UnitView[] {
  return crews.flatMap((crew) => crew.people.map((one) => one.unit));
}

function peopleIn(crews: readonly CrewOnDuty[]): number {
  return unitsIn(crews).length;
}
