/** Audio of the radio in step with a replay: which window is asked for, and how it is kept on time.  Pure. */

/** So much is asked for at once. */
export const WINDOW_MS = 300_000;
/** A difference of so much is a jump of the replay: the audio jumps, too. */
const JUMP_MS = 1_000;
/** A smaller one is made good by the speed, which nobody hears. */
const RATE_CHANGE_MAX = 0.1;
const MADE_GOOD_WITHIN_MS = 2_000;
const SLOWEST = 0.5;
const FASTEST = 2;

export interface AudioWindow {
  fromMs: number;
  lengthMs: number;
}

/** The window that has a time of the incident; it stays the same while the replay plays through it. */
export function windowAt(atMs: number, startMs: number, endMs: number): AudioWindow {
  const last = Math.max(startMs, endMs - 1);
  const inside = Math.min(Math.max(atMs, startMs), last);
  const fromMs = startMs + Math.floor((inside - startMs) / WINDOW_MS) * WINDOW_MS;
  return { fromMs, lengthMs: Math.max(1, Math.min(WINDOW_MS, endMs - fromMs)) };
}

/** Voice is understood at these speeds. */
export function isUnderstood(speed: number): boolean {
  return speed >= SLOWEST && speed <= FASTEST;
}

export interface Correction {
  /** The place to go to; null: it stays. */
  jumpMs: number | null;
  rate: number;
}

/** What brings the audio, which is at `mediaMs`, to where the replay is. */
export function correction(mediaMs: number, replayMs: number, speed: number): Correction {
  const lateMs = replayMs - mediaMs;
  if (Math.abs(lateMs) > JUMP_MS) return { jumpMs: replayMs, rate: speed };
  const change = Math.min(Math.max(lateMs / MADE_GOOD_WITHIN_MS, -RATE_CHANGE_MAX), RATE_CHANGE_MAX);
  return { jumpMs: null, rate: speed * (1 + change) };
}
