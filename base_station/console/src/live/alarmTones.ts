/** What is to be heard of the picture: new alarms at once, and what nobody takes again and again. Pure. */
import type { AlarmView } from "../wire";

export type Tone = "immediate" | "soon" | "link";

/** What has been sounded already. */
export interface ToneState {
  raisedMs: ReadonlyMap<string, number>; // of alarms, when they were raised last
  lastMs: number;
}

export const NO_TONES_YET: ToneState = { raisedMs: new Map(), lastMs: -Infinity };
/** Between two tones for the same, until somebody acknowledges it. */
export const REPEAT_AFTER_MS = 10_000;

export interface ToneInput {
  alarms: readonly AlarmView[];
  linkLost: boolean;
  nowMs: number; // of any clock that goes on
}

export function nextTone(
  { alarms, linkLost, nowMs }: ToneInput,
  before: ToneState,
): { tone: Tone | null; toneState: ToneState } {
  const raised = alarms.filter((alarm) => alarm.state === "raised" && alarm.priority <= 2);
  const urgent = raised.filter((alarm) => alarm.priority === 1);
  const isNew = (alarm: AlarmView) =>
    alarm.last_raised_ms > (before.raisedMs.get(alarm.alarm_id) ?? -Infinity);
  const again = nowMs - before.lastMs >= REPEAT_AFTER_MS;
  let tone: Tone | null = null;
  if (urgent.some(isNew) || (urgent.length > 0 && again)) tone = "immediate";
  else if (linkLost && again) tone = "link";
  else if (raised.some(isNew)) tone = "soon";
  const raisedMs = new Map(raised.map((alarm) => [alarm.alarm_id, alarm.last_raised_ms]));
  return { tone, toneState: { raisedMs, lastMs: tone === null ? before.lastMs : nowMs } };
}
