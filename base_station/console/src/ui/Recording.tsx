import { attempt, live, mayAct } from "../sessions";
import * as api from "../api";
import type { RecordingView } from "../wire";
import { bytes } from "../format";
import { codedText } from "../live/codedText";
import { knownLabel, t } from "../language/translate";

const HOUR_MS = 3_600_000;

/** A unit's black box, pulled over the bus with less priority than live data. */
export function Recording({ unitId }: { unitId: string }) {
  const picture = live.value?.picture;
  if (picture === undefined) return null;
  const pulls = picture.health.value?.recordings ?? [];
  const pull = pulls.filter((one) => one.unit_id === unitId).at(-1);
  if (pull !== undefined && !isOver(pull)) return <UnderWay pull={pull} />;
  return (
    <>
      <button
        type="button"
        aria-label={t("recording.fetch_of", { unit: unitId })}
        onClick={() => {
          const incident = picture.incident.peek();
          const wanted =
            incident === null
              ? { from_ms: Math.round(picture.nowMs.peek() - HOUR_MS) }
              : { incident_id: incident.incident_id };
          void attempt(api.fetchRecording(unitId, wanted));
        }}
      >
        {t("recording.fetch")}
      </button>
      {pull !== undefined && <small> {outcome(pull)}</small>}
    </>
  );
}

/** Recent transfers with their progress; empty without any. */
export function Recordings({ pulls }: { pulls: readonly RecordingView[] }) {
  if (pulls.length === 0) return null;
  return (
    <section aria-label={t("recording.title")}>
      <h3>{t("recording.title")}</h3>
      <ul class="recordings">
        {pulls.map((pull) => (
          <li key={pull.fetch_id}>
            <strong>{pull.unit_id}</strong>
            {isOver(pull) ? <span>{outcome(pull)}</span> : <UnderWay pull={pull} />}
          </li>
        ))}
      </ul>
    </section>
  );
}

function UnderWay({ pull }: { pull: RecordingView }) {
  const known = pull.total_bytes > 0;
  const state = knownLabel("transfer_state", pull.state) ?? pull.state;
  return (
    <span class="under-way">
      <label>
        {known
          ? t("recording.progress", { state, done: bytes(pull.done_bytes), total: bytes(pull.total_bytes) })
          : state}
        <progress {...(known ? { value: pull.done_bytes, max: pull.total_bytes } : {})} />
      </label>
      {pull.problem !== "" && <small>{problemOf(pull)}</small>}
      {mayAct.value && (
        <button
          type="button"
          aria-label={t("recording.stop_of", { unit: pull.unit_id })}
          onClick={() => void attempt(api.stopRecording(pull.fetch_id))}
        >
          {t("recording.stop")}
        </button>
      )}
    </span>
  );
}

function isOver(pull: RecordingView): boolean {
  return pull.state === "done" || pull.state === "failed";
}

function outcome(pull: RecordingView): string {
  if (pull.state !== "done") return problemOf(pull);
  return [t("recording.stored", { size: bytes(pull.total_bytes) }), problemOf(pull)].filter(Boolean).join("; ");
}

function problemOf(pull: RecordingView): string {
  return codedText(pull.problem_code ?? undefined, pull.problem);
}
