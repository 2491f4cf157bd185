import * as api from "../api";
import { t } from "../language/translate";
import { attempt } from "../sessions";
import { TimesFields, timesOf } from "./TimesFields";
import { useSinglePress } from "./useGuardedPress";
import { fields, useLoaded } from "./useLoaded";

interface Props {
  done: (opened: api.Incident | null) => void;
  beside?: boolean; // another one that is open
}

/** Opens an incident by its name. */
export function OpenIncidentForm({ done, beside = false }: Props) {
  const [usual] = useLoaded(api.usualTimes);
  const once = useSinglePress();
  return (
    <form
      class="row"
      onSubmit={(event) => {
        const given = fields(event);
        const times = usual.value === null ? {} : timesOf(given);
        const open = beside ? api.openBeside : api.openIncident;
        once(() => attempt(open(given["name"] ?? "", times)).then(done));
      }}
    >
      <label>
        {t("dispatch.incident_name")}
        <input name="name" required maxLength={80} autofocus />
      </label>
      <TimesFields key={usual.value === null ? "asked" : "known"} times={usual.value} />
      <button class="primary">{t(beside ? "incident.open_beside" : "dispatch.open_incident")}</button>
    </form>
  );
}
