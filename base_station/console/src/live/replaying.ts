/** Targets of seeks in a replay: from alarm to alarm, with a short lead.  Pure. */
import type { AlarmSentence } from "./alarmText";

/** Lead before an alarm. */
export const LEAD_MS = 5_000;
/** A second press within this time seeks the alarm before. */
const PATIENCE_MS = 3_000;

interface Raised {
  raised_ms: number;
}

interface RaisedOften extends Raised, AlarmSentence {
  raisings: readonly (AlarmSentence & { t_ms: number })[];
}

/** An entry for each raising of an alarm, first or repeated, by time and with its text at that time. */
export function eachRaising<A extends RaisedOften>(alarms: readonly A[]): A[] {
  return alarms
    .flatMap((alarm) =>
      alarm.raisings.map(({ t_ms, ...sentence }) => ({ ...alarm, ...sentence, raised_ms: t_ms })),
    )
    .sort((a, b) => a.raised_ms - b.raised_ms);
}

/** The time before the next alarm; null: there is none. */
export function nextAlarmMs(alarms: readonly Raised[], atMs: number): number | null {
  const later = starts(alarms).filter((startMs) => startMs > atMs);
  return later.length === 0 ? null : Math.min(...later);
}

/** The time before the alarm that came last; null: there was none. */
export function previousAlarmMs(alarms: readonly Raised[], atMs: number): number | null {
  const earlier = starts(alarms).filter((startMs) => startMs < atMs - PATIENCE_MS);
  return earlier.length === 0 ? null : Math.max(...earlier);
}

function starts(alarms: readonly Raised[]): number[] {
  return alarms.map(({ raised_ms }) => raised_ms - LEAD_MS);
}

export function within(atMs: number, startMs: number, endMs: number): number {
  return Math.min(Math.max(atMs, startMs), endMs);
}
