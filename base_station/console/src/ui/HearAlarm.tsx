import { useSignal } from "@preact/signals";
import * as api from "../api";
import { t } from "../language/translate";
import { picture, replay, user } from "../sessions";
import { useRadio } from "./useRadio";

const BEFORE_MS = 10_000;
const LENGTH_MS = 70_000;

/** The radio from ten seconds before an alarm on; nothing where none of that time was recorded. */
export function HearAlarm({ raisedMs }: { raisedMs: number }) {
  const incidentId = replay.value?.incident.incident_id ?? picture.value?.incident.value?.incident_id;
  if (incidentId === undefined || user.value?.role === "viewer") return null;
  return <Channels incidentId={incidentId} fromMs={raisedMs - BEFORE_MS} />;
}

function Channels({ incidentId, fromMs }: { incidentId: string; fromMs: number }) {
  const loaded = useRadio(incidentId);
  const channel = useSignal("");
  if (loaded.value === null) return null;
  const { from_ms: beginMs, channels } = loaded.value;
  const startMs = Math.round(Math.max(fromMs, beginMs));
  const there = channels.filter(({ recorded_ms: spans }) =>
    spans.some(([begin, end]) => begin < fromMs + LENGTH_MS && end > startMs),
  );
  return (
    <>
      {there.map(({ name }) => (
        <button type="button" key={name} onClick={() => (channel.value = name)}>
          {t("radio_audio.hear", { channel: name })}
        </button>
      ))}
      {channel.value !== "" && (
        <audio controls autoplay src={api.radioPath(incidentId, channel.value, startMs, LENGTH_MS)} />
      )}
    </>
  );
}
