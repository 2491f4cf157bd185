/** Tones of a picture: new alarms at once, unacknowledged ones again and again.  Pure. */
import type { AlarmView } from "../wire";

export type Tone = "high" | "medium" | "low" | "link";

const OF_PRIORITY: Record<number, Tone> = { 1: "high", 2: "medium", 3: "low" };
/** The most urgent first. */
const ORDER: readonly Tone[] = ["high", "link", "medium", "low"];
/** Interval between bursts of an unacknowledged alarm.  IEC 60601-1-8 requires at most 15 s between
 * bursts of high priority and 30 s of medium; of low at least 15 s. */
export const REPEAT_AFTER_MS: Record<Tone, number> = { high: 10_000, link: 10_000, medium: 20_000, low: 60_000 };
/** Longer than any burst: a repeat does not run into another. */
const BURST_MS = 4_000;

/** Tones played already. */
export interface ToneState {
  raisedMs: ReadonlyMap<string, number>; // of alarms, when they were raised last
  lastMs: Partial<Record<Tone, number>>;
}

export const NO_TONES_YET: ToneState = { raisedMs: new Map(), lastMs: {} };

export interface ToneInput {
  alarms: readonly AlarmView[];
  linkLost: boolean;
  nowMs: number; // of any clock that goes on
}

export interface Sounding {
  tone: Tone | null;
  alarm: AlarmView | null; // for which it sounds
  toneState: ToneState;
}

export function nextTone({ alarms, linkLost, nowMs }: ToneInput, before: ToneState): Sounding {
  const raised = alarms.filter(({ state, priority }) => state === "raised" && priority in OF_PRIORITY);
  const isNew = (alarm: AlarmView) =>
    alarm.last_raised_ms > (before.raisedMs.get(alarm.alarm_id) ?? -Infinity);
  const raisedMs = new Map(raised.map((alarm) => [alarm.alarm_id, alarm.last_raised_ms]));
  const last = Math.max(-Infinity, ...Object.values(before.lastMs));
  const free = nowMs - last >= BURST_MS;
  let waits = false; // for something more urgent that is repeated
  for (const tone of ORDER) {
    const of = raised.filter(({ priority }) => OF_PRIORITY[priority] === tone);
    const fresh = of.find(isNew);
    const present = tone === "link" ? linkLost : of.length > 0 && !waits;
    const due = free && nowMs - (before.lastMs[tone] ?? -Infinity) >= REPEAT_AFTER_MS[tone];
    if (fresh !== undefined || (present && due)) {
      const lastMs = { ...before.lastMs, [tone]: nowMs };
      return { tone, alarm: fresh ?? of[0] ?? null, toneState: { raisedMs, lastMs } };
    }
    waits ||= of.length > 0;
  }
  return { tone: null, alarm: null, toneState: { raisedMs, lastMs: before.lastMs } };
}
