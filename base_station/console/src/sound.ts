/** Alarms and a lost station are heard, unless somebody switched that off at this console. */
import { effect, signal } from "@preact/signals";
import type { Picture } from "./live/picture";
import { NO_TONES_YET, nextTone, type Tone } from "./live/alarmTones";

const KEPT_AS = "muster-sound";

export const soundOn = signal(localStorage.getItem(KEPT_AS) !== "off");
/** Browsers play nothing before the person has pressed anything on the page; to them a swipe is no
 * press. */
export const soundBlocked = signal(!navigator.userActivation.hasBeenActive);

// Only when the press has done its work: on the button that says "No sound yet" it means "on".
for (const kind of ["click", "keyup"]) {
  document.addEventListener(kind, () => {
    setTimeout(() => (soundBlocked.value &&= !navigator.userActivation.hasBeenActive));
  });
}

/** Switching on is heard. */
export function switchSound(on: boolean): void {
  soundOn.value = on;
  localStorage.setItem(KEPT_AS, on ? "on" : "off");
  if (on) play("soon");
}

/** Sound what a picture brings, until the returned function is called. */
export function sound(picture: Picture): () => void {
  let before = NO_TONES_YET;
  return effect(() => {
    void picture.nowMs.value; // goes on without the station too
    if (picture.replay.value !== null) return;
    const { tone, toneState } = nextTone(
      {
        alarms: picture.openAlarms.value,
        linkLost: picture.link.value.kind === "down",
        nowMs: performance.now(),
      },
      before,
    );
    before = toneState;
    if (tone !== null && soundOn.peek() && !soundBlocked.peek()) play(tone);
  });
}

/** Pitches in Hz, one after the other. */
const PITCHES: Record<Tone, readonly number[]> = {
  immediate: [880, 880, 880],
  soon: [660],
  link: [440, 330],
};
const TONE_S = 0.18;
const STEP_S = 0.3;
const OVER_MS = 2_000; // for the longest tone

function play(tone: Tone): void {
  const context = new AudioContext();
  const pitches = PITCHES[tone];
  pitches.forEach((pitch, i) => {
    const one = context.createOscillator();
    one.frequency.value = pitch;
    one.connect(context.destination);
    one.start(context.currentTime + i * STEP_S);
    one.stop(context.currentTime + i * STEP_S + TONE_S);
  });
  setTimeout(() => {
    soundBlocked.value = context.state !== "running"; // the browser has kept it silent
    void context.close();
  }, OVER_MS);
}
