/** Speech of alarms after their tone, where the browser can and the user has chosen it. */
import { t } from "./language/translate";
import { keptSwitch } from "./kept";
import { locale } from "./language/measures";
import type { Tone } from "./live/alarmTones";
import { alarmText } from "./live/alarmText";
import type { AlarmView } from "./wire";

export const canSpeak = "speechSynthesis" in window;
/** Off by default: a radio stands beside the console. */
export const speechOn = keptSwitch("muster-speech", "off");

/** When the bursts of a tone are over. */
const AFTER_MS: Partial<Record<Tone, number>> = { high: 3_400, medium: 1_100, link: 700 };

/** Only the newest: older alarms are no longer of interest. */
export function speak(tone: Tone, alarm: AlarmView | null): void {
  const afterMs = AFTER_MS[tone];
  const words = tone === "link" ? t("alarm_now.station_lost") : alarm && alarmText(alarm);
  if (!canSpeak || speechOn.peek() === "off" || afterMs === undefined || !words) return;
  setTimeout(() => {
    speechSynthesis.cancel();
    const utterance = new SpeechSynthesisUtterance(words);
    utterance.lang = locale();
    speechSynthesis.speak(utterance);
  }, afterMs);
}
