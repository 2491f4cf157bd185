import { t } from "../language/translate";
import { openDialog, rehearsed } from "../uiState";
import { Dialog } from "./Dialog";
import { onDemand } from "./onDemand";

const Rehearsal = onDemand(() => import("./Rehearsal").then((part) => part.Rehearsal));

/** Other alarm thresholds over a past incident. */
export function RehearsalDialog() {
  const incident = rehearsed.value;
  if (incident === null) return null;
  return (
    <Dialog title={t("incident.rehearse_of", { incident: incident.name })} wide>
      <Rehearsal incidentId={incident.incident_id} />
      <p class="ends">
        <button type="button" onClick={() => openDialog("incidents")}>
          {t("assessment.all_incidents")}
        </button>
      </p>
    </Dialog>
  );
}
