/** Sounds of alarms and of a lost station, unless switched off at this console. */
import { effect, signal } from "@preact/signals";
import type { Picture } from "./live/picture";
import { NO_TONES_YET, nextTone, type Tone } from "./live/alarmTones";
import { burst, type Pulse } from "./live/tonePulses";
import { speak } from "./speech";

const KEPT_AS = "muster-sound";

export const soundOn = signal(localStorage.getItem(KEPT_AS) !== "off");
/** Browsers block sound before the first press on the page; a swipe is no press. */
export const soundBlocked = signal(!navigator.userActivation.hasBeenActive);

// Only when the press has done its work: on the button that says "No sound yet" it means "on".
for (const kind of ["click", "keyup"]) {
  document.addEventListener(kind, () => {
    setTimeout(() => (soundBlocked.value &&= !navigator.userActivation.hasBeenActive));
  });
}

/** Switching on plays a sample. */
export function switchSound(on: boolean): void {
  soundOn.value = on;
  localStorage.setItem(KEPT_AS, on ? "on" : "off");
  if (on) play("medium");
}

/** Plays the sounds of a picture until the returned function is called. */
export function sound(picture: Picture): () => void {
  let before = NO_TONES_YET;
  return effect(() => {
    void picture.nowMs.value; // goes on without the station too
    if (picture.replay.value !== null) return;
    const { tone, alarm, toneState } = nextTone(
      {
        alarms: picture.openAlarms.value,
        linkLost: picture.link.value.kind === "down",
        nowMs: performance.now(),
      },
      before,
    );
    before = toneState;
    if (tone === null || !soundOn.peek() || soundBlocked.peek()) return;
    play(tone);
    speak(tone, alarm);
  });
}

/** IEC 60601-1-8: at least four harmonics between 300 and 4000 Hz, within 15 dB of the fundamental. */
const HARMONICS = [0, 1, 0.8, 0.65, 0.5, 0.4];
const RISE = 0.15; // of a pulse: it begins and ends without a click
const LOUDNESS = 0.5; // of full scale
const OVER_MS = 4_500; // for the longest burst

function play(tone: Tone): void {
  const context = new AudioContext();
  const wave = context.createPeriodicWave(
    new Float32Array(HARMONICS.length),
    new Float32Array(HARMONICS),
  );
  for (const pulse of burst(tone)) schedule(context, wave, pulse);
  setTimeout(() => {
    soundBlocked.value = context.state !== "running"; // the browser has kept it silent
    void context.close();
  }, OVER_MS);
}

function schedule(context: AudioContext, wave: PeriodicWave, { startS, durationS, pitchHz }: Pulse): void {
  const from = context.currentTime + startS;
  const until = from + durationS;
  const rise = RISE * durationS;
  const gain = context.createGain();
  gain.gain.setValueAtTime(0, from);
  gain.gain.linearRampToValueAtTime(LOUDNESS, from + rise);
  gain.gain.setValueAtTime(LOUDNESS, until - rise);
  gain.gain.linearRampToValueAtTime(0, until);
  const oscillator = context.createOscillator();
  oscillator.setPeriodicWave(wave);
  oscillator.frequency.value = pitchHz;
  oscillator.connect(gain).connect(context.destination);
  oscillator.start(from);
  oscillator.stop(until);
}
