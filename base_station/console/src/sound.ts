/** Three short tones when an immediate alarm appears; only for who asked for sound. */
import { useEffect, useRef } from "preact/hooks";
import type { AlarmView } from "./wire";

const TONES = 3;
const TONE_S = 0.18;
const STEP_S = 0.3;

export function useBeeper(on: boolean, alarms: readonly AlarmView[]): void {
  const heard = useRef<Set<string>>(new Set());
  useEffect(() => {
    const urgent = alarms.filter((alarm) => alarm.priority === 1 && alarm.state === "raised");
    const fresh = urgent.some((alarm) => !heard.current.has(alarm.alarm_id));
    heard.current = new Set(urgent.map((alarm) => alarm.alarm_id));
    if (on && fresh) beep();
  }, [on, alarms]);
}

function beep(): void {
  const context = new AudioContext();
  for (let i = 0; i < TONES; i++) {
    const tone = context.createOscillator();
    tone.frequency.value = 880;
    tone.connect(context.destination);
    tone.start(context.currentTime + i * STEP_S);
    tone.stop(context.currentTime + i * STEP_S + TONE_S);
    if (i === TONES - 1) tone.onended = () => void context.close();
  }
}
