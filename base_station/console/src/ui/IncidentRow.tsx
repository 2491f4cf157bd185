import * as api from "../api";
import { dateAndTime, minutes } from "../format";
import { listed } from "../language/measures";
import { t } from "../language/translate";
import { watchReplay } from "../sessions";
import { assess, openImports, openRehearsal } from "../uiState";
import { EraseForm } from "./EraseForm";
import { Downloads, Report } from "./IncidentFiles";

interface Props {
  incident: api.Incident;
  all: readonly api.Incident[]; // of the list
  formats: readonly api.ExportFormat[];
  forgets: boolean; // the user may erase
  done: () => void;
}

/** An incident of the list, and what can be done with it. */
export function IncidentRow({ incident, all, formats, forgets, done }: Props) {
  return (
    <tr>
      <th scope="row">
        {incident.name}
        {incident.dispatch_number !== "" && (
          <span class="quiet"> {t("dispatch.title", { number: incident.dispatch_number })}</span>
        )}
      </th>
      <td data-label={t("incident.opened")}>{dateAndTime(incident.opened_ms)}</td>
      <td data-label={t("incident.duration")}>
        {incident.closed_ms === null
          ? t("incident.still_open")
          : minutes(incident.closed_ms - incident.opened_ms)}
        {incident.archived_ms !== null && (
          <span class="quiet">
            {" "}
            {t("incident.archived", { time: dateAndTime(incident.archived_ms) })}
          </span>
        )}
        {incident.erased_at_ms !== null && (
          <span class="quiet">
            {" "}
            {t("incident.erased_at", { time: dateAndTime(incident.erased_at_ms) })}
          </span>
        )}
      </td>
      <td>
        <button
          type="button"
          aria-label={t("incident.replay_of", { incident: incident.name })}
          onClick={() => void watchReplay(incident)}
        >
          {t("incident.replay")}
        </button>{" "}
        <button
          type="button"
          aria-label={t("imports.open_about", { incident: incident.name })}
          onClick={() => openImports(incident)}
        >
          {t("imports.open")}
        </button>
      </td>
      <td>
        <Downloads incident={incident} formats={formats} />
      </td>
      <td data-label={t("incident.report")}>
        <Report incident={incident} />
      </td>
      <td>
        <button
          type="button"
          aria-label={t("assessment.title", { incident: incident.name })}
          onClick={() => assess(incident)}
        >
          {t("incident.accuracy")}
        </button>{" "}
        {incident.closed_ms !== null && (
          <button
            type="button"
            aria-label={t("incident.rehearse_of", { incident: incident.name })}
            onClick={() => openRehearsal(incident)}
          >
            {t("incident.rehearse")}
          </button>
        )}
      </td>
      {forgets && (
        <td>
          {incident.closed_ms !== null && (
            <EraseForm
              name={incident.name}
              warning={eraseWarning(incident, all)}
              subjectId={incident.incident_id}
              forget={(name) => api.forgetIncident(incident.incident_id, name)}
              done={done}
            />
          )}
        </td>
      )}
    </tr>
  );
}

/** Names the incidents of the list that were open while this one was. */
function eraseWarning(incident: api.Incident, all: readonly api.Incident[]): string {
  const endMs = (one: api.Incident) => one.closed_ms ?? Infinity;
  const beside = all.filter(
    (one) =>
      one.incident_id !== incident.incident_id &&
      one.opened_ms < endMs(incident) &&
      incident.opened_ms < endMs(one),
  );
  if (beside.length === 0) return t("incident.erase_warning");
  const others = listed(beside.map((one) => one.name));
  return t("incident.erase_warning_beside", { others });
}
