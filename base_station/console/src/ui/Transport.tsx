import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { steer, type Replay } from "../sessions";
import * as api from "../api";
import { eachRaising, LEAD_MS, nextAlarmMs, previousAlarmMs, within } from "../live/replaying";
import type { ReplayView } from "../wire";
import { countdown, duration, timeSince } from "../format";
import { t } from "../language/translate";
import { alarmText } from "../live/alarmText";
import { Icon, type IconName } from "./Icon";
import { useChosen } from "./useChosen";
import { useLoaded } from "./useLoaded";

const SPEEDS = [0.5, 1, 2, 4, 8, 16, 32, 64];
const STEP_MS = 10_000;
const ASK_AGAIN_MS = 5_000;

interface Props {
  replay: Replay;
  state: ReplayView;
}

/** Play, seek and speed; the alarms are marks on the way and places to go to. */
export function Transport({ replay, state }: Props) {
  const loaded = usePastAlarms(replay.incident.incident_id);
  const alarms = eachRaising(loaded ?? []);
  const { start_ms: start, end_ms: end, at_ms: at, playing } = state;
  const change = (what: api.ReplayChange) => steer(replay, what);
  const seek = (ms: number) => change({ at_ms: Math.round(within(ms, start, end)) });
  const jump = (ms: number | null) => (ms === null ? undefined : () => seek(ms));
  return (
    <div class="transport">
      <Step icon="back" word={t("transport.alarm_before")} shown={t("transport.alarm")} go={jump(previousAlarmMs(alarms, at))} />
      <Step icon="back" word={t("transport.back", { time: duration(STEP_MS) })} shown={duration(STEP_MS)} go={jump(at - STEP_MS)} />
      <Step
        icon={playing ? "pause" : "play"}
        word={t(playing ? "transport.pause" : "transport.play")}
        go={() => change({ playing: !playing })}
      />
      <Step icon="forth" word={t("transport.on", { time: duration(STEP_MS) })} shown={duration(STEP_MS)} go={jump(at + STEP_MS)} />
      <Step icon="forth" word={t("transport.next_alarm")} shown={t("transport.alarm")} go={jump(nextAlarmMs(alarms, at))} />
      <SeekBar state={state} alarms={alarms} seek={seek} />
      <span class="going" role="status">
        {state.seeking ? t("transport.going", { time: timeSince(start, at) }) : ""}
      </span>
      {!state.seeking && (
        <span>{t("transport.progress", { at: countdown(at - start), all: countdown(end - start) })}</span>
      )}
      <GoTo alarms={alarms} isKnown={loaded !== null} sinceMs={start} seek={seek} />
      <Speed state={state} choose={(speed) => change({ speed })} />
    </div>
  );
}

/** Alarms of the incident; null until the station has them, which of a log without a database takes minutes. */
function usePastAlarms(incidentId: string): readonly api.PastAlarm[] | null {
  const [loaded] = useLoaded(() => api.incidentAlarms(incidentId));
  const isKnown = loaded.value !== null;
  useEffect(() => {
    if (isKnown) return;
    const take = (answer: readonly api.PastAlarm[]) => (loaded.value = [...answer]);
    const ask = () => void api.incidentAlarms(incidentId).then(take, () => undefined); // the reason was shown
    const timer = setInterval(ask, ASK_AGAIN_MS);
    return () => clearInterval(timer);
  }, [isKnown]);
  return loaded.value;
}

interface StepProps {
  icon: IconName;
  word: string;
  shown?: string; // beside the icon
  go: (() => void) | undefined; // undefined: there is nothing in that direction
}

function Step({ icon, word, shown, go }: StepProps) {
  return (
    <button type="button" aria-label={word} title={word} disabled={go === undefined} onClick={go}>
      <Icon name={icon} />
      {shown}
    </button>
  );
}

interface SeekProps {
  alarms: readonly api.PastAlarm[];
  seek: (ms: number) => void;
}

/** An alarm may have been raised more than once. */
function keyOf({ alarm_id, raised_ms }: api.PastAlarm): string {
  return `${alarm_id} ${raised_ms}`;
}

/** The alarms in words, to go to. */
function GoTo({ alarms, isKnown, sinceMs, seek }: SeekProps & { isKnown: boolean; sinceMs: number }) {
  const none = isKnown ? t("transport.no_alarms") : t("transport.alarms_unknown");
  const chosen = useChosen("", (raisedMs) => seek(Number(raisedMs) - LEAD_MS));
  return (
    <select
      class="go-to"
      aria-label={t("transport.go_to")}
      disabled={alarms.length === 0}
      {...chosen}
    >
      <option value="">{alarms.length === 0 ? none : t("transport.alarms", { count: alarms.length })}</option>
      {alarms.map((alarm) => (
        <option key={keyOf(alarm)} value={alarm.raised_ms}>
          {timeSince(sinceMs, alarm.raised_ms)} {alarmText(alarm)}
        </option>
      ))}
    </select>
  );
}

function Speed({ state, choose }: { state: ReplayView; choose: (speed: number) => void }) {
  const speeds = [...new Set([...SPEEDS, state.speed])].sort((a, b) => a - b);
  return (
    <select
      aria-label={t("transport.speed")}
      value={String(state.speed)}
      onChange={(event) => choose(Number(event.currentTarget.value))}
    >
      {speeds.map((speed) => (
        <option key={speed} value={String(speed)}>
          {speed}×
        </option>
      ))}
    </select>
  );
}

/** The incident's time from left to right, with a mark where an alarm was raised. */
function SeekBar({ state, alarms, seek }: SeekProps & { state: ReplayView }) {
  const dragged = useSignal<number | null>(null);
  const { start_ms: start, end_ms: end, at_ms: at } = state;
  const shown = dragged.value ?? at;
  return (
    <span class="seek">
      <svg class="seek-marks" viewBox="0 0 1000 10" preserveAspectRatio="none" aria-hidden="true">
        {alarms.map((alarm) => (
          <rect
            key={keyOf(alarm)}
            class={`p${alarm.priority}`}
            x={(1000 * (alarm.raised_ms - start)) / Math.max(1, end - start) - 2}
            width="4"
            height="10"
          />
        ))}
      </svg>
      <input
        type="range"
        aria-label={t("transport.time")}
        aria-valuetext={timeSince(state.start_ms, shown)}
        min={start}
        max={end}
        step={1000}
        value={shown}
        onInput={(event) => (dragged.value = Number(event.currentTarget.value))}
        onChange={(event) => {
          dragged.value = null;
          seek(Number(event.currentTarget.value));
        }}
      />
    </span>
  );
}
