import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { attempt, besideLive, stopReplay, type Replay } from "../sessions";
import * as api from "../api";
import type { Picture } from "../live/picture";
import { clockTime, dateAndTime, duration } from "../words";
import { Icon } from "./Icon";

const SPEEDS = [0.5, 1, 2, 4, 8, 16];

/** The usual speeds, and the one it has. */
function speeds(now: number): number[] {
  return [...new Set([...SPEEDS, now])].sort((a, b) => a - b);
}

interface Props {
  replay: Replay;
  live: Picture;
}

/** Nobody may take the past for the present: a banner, a frame, and what is live beside it. */
export function ReplayBar({ replay, live }: Props) {
  const state = replay.session.picture.replay.value;
  const change = (what: api.ReplayChange) => void attempt(api.changeReplay(replay.id, what));
  return (
    <section class="replay-bar" aria-label="Replay">
      <strong class="replay-word">REPLAY</strong>
      <span class="replay-what">
        {replay.incident.name}, {dateAndTime(replay.incident.opened_ms)}. This is the past.
      </span>
      {besideLive.value && (
        <>
          <LiveAlarms live={live} />
          <button type="button" class="primary" onClick={stopReplay}>
            Back to live
          </button>
        </>
      )}
      {state && (
        <div class="transport">
          <button
            type="button"
            class="play"
            aria-label={state.playing ? "Pause" : "Play"}
            onClick={() => change({ playing: !state.playing })}
          >
            <Icon name={state.playing ? "pause" : "play"} />
          </button>
          <time>{clockTime(state.at_ms)}</time>
          <SeekBar replay={replay} start={state.start_ms} end={state.end_ms} at={state.at_ms} />
          <span class="quiet">of {duration(state.end_ms - state.start_ms)}</span>
          <label>
            Speed
            <select
              value={String(state.speed)}
              onChange={(event) => change({ speed: Number(event.currentTarget.value) })}
            >
              {speeds(state.speed).map((speed) => (
                <option key={speed} value={String(speed)}>
                  {speed}×
                </option>
              ))}
            </select>
          </label>
        </div>
      )}
    </section>
  );
}

function LiveAlarms({ live }: { live: Picture }) {
  const open = live.openAlarms.value.length;
  if (open === 0) return <span class="replay-live">Live now: no open alarms</span>;
  return (
    <span class="replay-live alarmed" role="alert">
      <Icon name="alarm" /> Live now: {open} open {open === 1 ? "alarm" : "alarms"}
    </span>
  );
}

interface SeekProps {
  replay: Props["replay"];
  start: number;
  end: number;
  at: number;
}

/** The incident's time from left to right, with a mark where an alarm was raised. */
function SeekBar({ replay, start, end, at }: SeekProps) {
  const marks = useSignal<api.PastAlarm[]>([]);
  const dragged = useSignal<number | null>(null);
  useEffect(() => {
    void attempt(api.incidentAlarms(replay.incident.incident_id)).then((alarms) => {
      marks.value = alarms ?? [];
    });
  }, [replay.id]);
  const shown = dragged.value ?? at;
  return (
    <span class="seek">
      <svg class="seek-marks" viewBox="0 0 1000 10" preserveAspectRatio="none" aria-hidden="true">
        {marks.value.map((alarm) => (
          <rect
            key={alarm.alarm_id}
            class={`p${alarm.priority}`}
            x={(1000 * (alarm.raised_ms - start)) / Math.max(1, end - start) - 2}
            width="4"
            height="10"
          />
        ))}
      </svg>
      <input
        type="range"
        aria-label="Time of the incident"
        aria-valuetext={clockTime(shown)}
        min={start}
        max={end}
        step={1000}
        value={shown}
        onInput={(event) => (dragged.value = Number(event.currentTarget.value))}
        onChange={(event) => {
          dragged.value = null;
          void attempt(api.changeReplay(replay.id, { at_ms: Number(event.currentTarget.value) }));
        }}
      />
    </span>
  );
}
