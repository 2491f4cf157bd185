import { useSignal } from "@preact/signals";
import * as api from "../api";
import { crewsOf, type Target } from "../live/commands";
import type { Picture } from "../live/picture";
import { nameAmong } from "../live/urgency";
import { attempt } from "../sessions";
import type { IncidentView, UnitView } from "../wire";
import { t } from "../language/translate";
import { useSinglePress } from "./useGuardedPress";

interface Props {
  incident: IncidentView;
  picture: Picture;
}

/** Assignment of a crew or a unit of another incident, or of none, to the shown one. */
export function AssignForm({ incident, picture }: Props) {
  const whom = useSignal("");
  const once = useSinglePress();
  void picture.unitsChanged.value;
  const others = picture.unitsOfAll().filter((unit) => unit.registered && !picture.isShown(unit.unit_id));
  const targets = new Map<string, string>([
    ...crewsOf(others).map((crew) => [`crew:${crew}`, crew] as const),
    ...others.map((unit) => [`unit:${unit.unit_id}`, wordsOf(unit, picture)] as const),
  ]);
  const chosen = targets.has(whom.value) ? whom.value : "";
  return (
    <form
      class="row"
      onSubmit={(event) => {
        event.preventDefault();
        once(() => attempt(api.assignMembers(incident.incident_id, targetOf(chosen))));
      }}
    >
      <label>
        {t("incident.whom")}
        <select required value={chosen} onChange={(event) => (whom.value = event.currentTarget.value)}>
          <option value="">{t(others.length === 0 ? "incident.nobody_elsewhere" : "incident.choose")}</option>
          {[...targets].map(([target, words]) => (
            <option key={target} value={target}>
              {words}
            </option>
          ))}
        </select>
      </label>
      <button disabled={others.length === 0}>{t("card.assign_incident")}</button>
      <p class="quiet">{t("incident.assign_hint")}</p>
    </form>
  );
}

/** "Jonas Bergman, in Harbour". */
function wordsOf(unit: UnitView, picture: Picture): string {
  const other = picture.otherIncidentOf(unit.unit_id);
  const member = nameAmong(unit, picture.unitsOfAll());
  if (other === null) return t("incident.member_unassigned", { member });
  return t("incident.member_in", { member, incident: other.name });
}

function targetOf(chosen: string): Target {
  const name = chosen.slice(chosen.indexOf(":") + 1);
  return chosen.startsWith("crew:") ? { crew: name } : { unit_id: name };
}
