/** What is to be heard of the picture: new alarms at once, and what nobody takes again and again. Pure. */
import type { AlarmView } from "../wire";

export type Tone = "immediate" | "soon" | "link";

/** What has been sounded already. */
export interface Sounded {
  raisedMs: ReadonlyMap<string, number>; // of alarms, when they were raised last
  lastMs: number;
}

export const NOTHING_YET: Sounded = { raisedMs: new Map(), lastMs: -Infinity };
/** Between two tones for the same, until somebody acknowledges it. */
export const AGAIN_MS = 10_000;

export interface Heard {
  alarms: readonly AlarmView[];
  linkLost: boolean;
  nowMs: number; // of any clock that goes on
}

export function toneOf(
  { alarms, linkLost, nowMs }: Heard,
  before: Sounded,
): { tone: Tone | null; sounded: Sounded } {
  const raised = alarms.filter((alarm) => alarm.state === "raised" && alarm.priority <= 2);
  const urgent = raised.filter((alarm) => alarm.priority === 1);
  const isNew = (alarm: AlarmView) =>
    alarm.last_raised_ms > (before.raisedMs.get(alarm.alarm_id) ?? -Infinity);
  const again = nowMs - before.lastMs >= AGAIN_MS;
  let tone: Tone | null = null;
  if (urgent.some(isNew) || (urgent.length > 0 && again)) tone = "immediate";
  else if (linkLost && again) tone = "link";
  else if (raised.some(isNew)) tone = "soon";
  const raisedMs = new Map(raised.map((alarm) => [alarm.alarm_id, alarm.last_raised_ms]));
  return { tone, sounded: { raisedMs, lastMs: tone === null ? before.lastMs : nowMs } };
}
