import { useSignal } from "@preact/signals";
import * as api from "../api";
import { t } from "../language/translate";
import { KINDS, type TrailKind } from "../plan/pastTrails";
import { saveAs } from "../saving";
import { attempt, user } from "../sessions";
import { useChosen } from "./useChosen";

/** With a plain link the browser would leave the console for a refusal. */
async function save(content: Promise<Blob>, name: string): Promise<void> {
  saveAs(name, await content);
}

interface DownloadsProps {
  incident: api.Incident;
  formats: readonly api.ExportFormat[];
}

const WHOLE = "mcap";
const WITH_RADIO = "mcap with radio";

/** Export of an incident for other programs: its tracks, or all data. */
export function Downloads({ incident, formats }: DownloadsProps) {
  const writing = useSignal(false);
  const files = KINDS.flatMap((kind) => formats.map((format) => ({ kind, format })));
  const write = async (content: Promise<Blob>, ending: string) => {
    writing.value = true;
    await attempt(save(content, `${incident.incident_id}${ending}`));
    writing.value = false;
  };
  const chosen = useChosen("", async (key) => {
    if (key === WHOLE || key === WITH_RADIO) {
      return write(api.wholeIncident(incident.incident_id, key === WITH_RADIO), `.${WHOLE}`);
    }
    const file = files.find((one) => keyOf(one.kind, one.format) === key);
    if (file === undefined) return;
    const which = file.kind === "fused" ? "" : `-${file.kind}`; // as the station names it
    const content = api.exported(incident.incident_id, file.format.name, file.kind);
    await write(content, `${which}.${file.format.suffix}`);
  });
  return (
    <select
      aria-label={t("incident.save_of", { incident: incident.name })}
      disabled={writing.value}
      {...chosen}
    >
      <option value="">{t(writing.value ? "incident.writing" : "incident.save_as")}</option>
      {KINDS.map((kind) => (
        <optgroup key={kind} label={t(`trail.${kind}`)}>
          {formats.map((format) => (
            <option key={format.name} value={keyOf(kind, format)}>
              {format.name}
            </option>
          ))}
        </optgroup>
      ))}
      <optgroup label={t("incident.whole")}>
        <option value={WHOLE}>{WHOLE}</option>
        {user.value?.role !== "viewer" && (
          <option value={WITH_RADIO}>{t("incident.with_radio", { format: WHOLE })}</option>
        )}
      </optgroup>
    </select>
  );
}

/** Report of the incident as a document. */
export function Report({ incident }: { incident: api.Incident }) {
  const writing = useSignal(false);
  const write = async (suffix: "html" | "pdf") => {
    writing.value = true;
    const content = api.report(incident.incident_id, suffix);
    await attempt(save(content, `${incident.incident_id}-report.${suffix}`));
    writing.value = false;
  };
  return (
    <span class="row">
      {(["html", "pdf"] as const).map((suffix) => (
        <button
          key={suffix}
          type="button"
          disabled={writing.value}
          aria-label={t("incident.report_of", { incident: incident.name, format: suffix.toUpperCase() })}
          onClick={() => void write(suffix)}
        >
          {suffix.toUpperCase()}
        </button>
      ))}
    </span>
  );
}

function keyOf(kind: TrailKind, format: api.ExportFormat): string {
  return `${format.name} ${kind}`;
}
