/** Audio of the radio synchronised with a replay: the requested window, and the correction of its time.
 * Pure. */

/** Length of one request. */
export const WINDOW_MS = 300_000;
/** A larger difference is a seek of the replay: the audio seeks, too. */
const JUMP_MS = 1_000;
/** A smaller difference is corrected by an inaudible change of the speed. */
const RATE_CHANGE_MAX = 0.1;
const MADE_GOOD_WITHIN_MS = 2_000;
const SLOWEST = 0.5;
const FASTEST = 2;

export interface AudioWindow {
  fromMs: number;
  lengthMs: number;
}

/** The window that contains a time of the incident; it stays the same while the replay plays through it. */
export function windowAt(atMs: number, startMs: number, endMs: number): AudioWindow {
  const last = Math.max(startMs, endMs - 1);
  const inside = Math.min(Math.max(atMs, startMs), last);
  const fromMs = startMs + Math.floor((inside - startMs) / WINDOW_MS) * WINDOW_MS;
  return { fromMs, lengthMs: Math.max(1, Math.min(WINDOW_MS, endMs - fromMs)) };
}

/** Speeds at which voice is intelligible. */
export function isUnderstood(speed: number): boolean {
  return speed >= SLOWEST && speed <= FASTEST;
}

export interface Correction {
  /** The position to seek; null: none. */
  jumpMs: number | null;
  rate: number;
}

/** Correction that brings the audio from `mediaMs` to the time of the replay. */
export function correction(mediaMs: number, replayMs: number, speed: number): Correction {
  const lateMs = replayMs - mediaMs;
  if (Math.abs(lateMs) > JUMP_MS) return { jumpMs: replayMs, rate: speed };
  const change = Math.min(Math.max(lateMs / MADE_GOOD_WITHIN_MS, -RATE_CHANGE_MAX), RATE_CHANGE_MAX);
  return { jumpMs: null, rate: speed * (1 + change) };
}
