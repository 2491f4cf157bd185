import type { IncidentChoice } from "../live/incidents";
import type { Picture } from "../live/picture";
import { t } from "../language/translate";
import { showIncident } from "./showIncident";
import { useChosen } from "./useChosen";

/** Which of several open incidents is shown; each with how many alarms are open in it, if any. */
export function IncidentSwitch({ picture }: { picture: Picture }) {
  const shown = picture.incident.value?.incident_id ?? "";
  const chosen = useChosen(shown, (incidentId) => showIncident(picture, incidentId));
  return (
    <select class="incident-switch" aria-label={t("incident.switch")} {...chosen}>
      {picture.choices.value.map((choice) => (
        <option key={choice.incident.incident_id} value={choice.incident.incident_id}>
          {wordsOf(choice)}
        </option>
      ))}
    </select>
  );
}

function wordsOf({ incident, openAlarms }: IncidentChoice): string {
  if (openAlarms === 0) return incident.name; // a low screen has no room for more
  return t("incident.choice", { incident: incident.name, count: openAlarms });
}
