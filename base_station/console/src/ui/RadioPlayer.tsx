import { signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import * as api from "../api";
import { t } from "../language/translate";
import { correction, isUnderstood, windowAt } from "../live/radioSync";
import { user, type Replay } from "../sessions";
import type { ReplayView } from "../wire";
import { useRadio } from "./useRadio";

/** Of this page: off by default. */
const isOn = signal(false);
const volume = signal(0.8);
const chosen = signal("");

interface Props {
  replay: Replay;
  state: ReplayView;
}

/** The radio of the incident, in step with its replay; nothing without recordings, or without the right. */
export function RadioPlayer({ replay, state }: Props) {
  const loaded = useRadio(replay.incident.incident_id);
  const channels = (loaded.value?.channels ?? []).map(({ name }) => name);
  const [first] = channels;
  if (first === undefined || user.value?.role === "viewer") return null;
  const channel = channels.includes(chosen.value) ? chosen.value : first;
  return (
    <div class="radio-player" role="group" aria-label={t("radio_audio.title")}>
      <button type="button" aria-pressed={isOn.value} onClick={() => (isOn.value = !isOn.value)}>
        {isOn.value ? t("radio_audio.on") : t("radio_audio.off")}
      </button>
      {channels.length > 1 && (
        <select
          aria-label={t("radio_audio.channel")}
          value={channel}
          onChange={(event) => (chosen.value = event.currentTarget.value)}
        >
          {channels.map((name) => (
            <option key={name} value={name}>
              {name}
            </option>
          ))}
        </select>
      )}
      {isOn.value && (
        <input
          type="range"
          aria-label={t("radio_audio.volume")}
          min={0}
          max={1}
          step={0.05}
          value={volume.value}
          onInput={(event) => (volume.value = Number(event.currentTarget.value))}
        />
      )}
      {isOn.value && !isUnderstood(state.speed) && <span>{t("radio_audio.too_fast")}</span>}
      {isOn.value && <Sound incidentId={replay.incident.incident_id} channel={channel} state={state} />}
    </div>
  );
}

/** Follows the replay: its place, whether it plays, and its speed. */
function Sound({ incidentId, channel, state }: { incidentId: string; channel: string; state: ReplayView }) {
  const audio = useRef<HTMLAudioElement>(null);
  const { fromMs, lengthMs } = windowAt(state.at_ms, state.start_ms, state.end_ms);
  const plays = state.playing && !state.seeking && isUnderstood(state.speed);
  useEffect(() => {
    const element = audio.current;
    if (element === null) return;
    element.volume = volume.value;
    const mediaMs = fromMs + 1000 * element.currentTime;
    const { jumpMs, rate } = correction(mediaMs, state.at_ms, plays ? state.speed : 1);
    element.playbackRate = rate;
    if (jumpMs !== null) element.currentTime = (jumpMs - fromMs) / 1000;
    if (!plays) element.pause();
    else if (element.paused) void element.play().catch(() => undefined); // it is still being fetched
  }, [state.at_ms, state.speed, plays, fromMs, volume.value]);
  return (
    <audio
      key={`${channel} ${fromMs}`}
      ref={audio}
      preload="auto"
      src={api.radioPath(incidentId, channel, fromMs, lengthMs)}
      data-from-ms={fromMs}
    />
  );
}
