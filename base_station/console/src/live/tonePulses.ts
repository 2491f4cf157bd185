/** Auditory alarm signals after IEC 60601-1-8:2006+A1:2012, tables 3 and 4 and annex F: bursts of ten pulses
 * for high priority, three for medium, two for low.  Pure. */
import type { Tone } from "./alarmTones";

export interface Pulse {
  startS: number; // from the start of the burst
  durationS: number;
  pitchHz: number; // of the fundamental; the standard wants 150 to 1000 Hz
}

const C5_HZ = 523.25;
const E5_HZ = 659.26;
const A4_HZ = 440;
const E4_HZ = 329.63;

const HIGH_PULSE_S = 0.15; // 75 to 200 ms
const HIGH_GAP_S = 0.1; // "x", 50 to 125 ms
const HALVES_GAP_S = 0.5; // between the fifth and the sixth, 0.35 to 1.3 s
const PULSE_S = 0.2; // medium and low: 125 to 250 ms
const GAP_S = 0.2; // "y", 125 to 250 ms

/** One burst.  A lost station has two falling notes, which no priority has. */
export function burst(tone: Tone): Pulse[] {
  switch (tone) {
    case "high":
      return highBurst();
    case "medium":
      return inARow([C5_HZ, C5_HZ, C5_HZ]);
    case "low":
      return inARow([E5_HZ, C5_HZ]);
    case "link":
      return inARow([A4_HZ, E4_HZ]);
  }
}

/** Three and two pulses, and the same again; between the third and the fourth one is left out. */
function highBurst(): Pulse[] {
  const step = HIGH_PULSE_S + HIGH_GAP_S;
  const half = [0, 1, 2, 4, 5].map((steps) => steps * step);
  const secondS = 5 * step + HIGH_PULSE_S + HALVES_GAP_S;
  return [...half, ...half.map((startS) => startS + secondS)].map((startS) => ({
    startS,
    durationS: HIGH_PULSE_S,
    pitchHz: C5_HZ,
  }));
}

function inARow(pitchesHz: readonly number[]): Pulse[] {
  return pitchesHz.map((pitchHz, i) => ({ startS: i * (PULSE_S + GAP_S), durationS: PULSE_S, pitchHz }));
}
