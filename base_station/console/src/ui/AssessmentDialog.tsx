import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { attempt } from "../sessions";
import { assessed, openDialog } from "../uiState";
import * as api from "../api";
import type { Assessment } from "../assessment";
import { t } from "../language/translate";
import { Dialog } from "./Dialog";
import { onDemand } from "./onDemand";

const AccuracyReport = onDemand(() => import("./AccuracyReport").then((part) => part.AccuracyReport));

/** Accuracy stated at the time, compared with the smoothed trails. */
export function AssessmentDialog() {
  const incident = assessed.value;
  const report = useSignal<Assessment | "asked" | "failed">("asked");
  useEffect(() => {
    if (incident === null) return;
    void attempt(api.assessment(incident.incident_id)).then((answer) => {
      report.value = answer ?? "failed";
    });
  }, [incident]);
  if (incident === null) return null;
  return (
    <Dialog title={t("assessment.title", { incident: incident.name })} wide>
      <div aria-live="polite" aria-busy={report.value === "asked"}>
        <Answer report={report.value} />
      </div>
      <p class="ends">
        <button type="button" onClick={() => openDialog("incidents")}>
          {t("assessment.all_incidents")}
        </button>
      </p>
    </Dialog>
  );
}

function Answer({ report }: { report: Assessment | "asked" | "failed" }) {
  if (report === "asked") return <p>{t("assessment.waiting")}</p>;
  if (report === "failed") return <p class="warned">{t("assessment.failed")}</p>;
  if (report.units.length === 0) return <p>{t("assessment.nobody")}</p>;
  return <AccuracyReport report={report} />;
}
