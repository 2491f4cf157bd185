import { soundBlocked, soundOn, switchSound } from "../sound";
import { t } from "../language/translate";
import { Icon } from "./Icon";

/** Switch for the sounds of alarms at this console. */
export function SoundButton() {
  const heard = soundOn.value && !soundBlocked.value;
  const word = t(!soundOn.value ? "sound.off" : heard ? "sound.on" : "sound.blocked");
  return (
    <button
      type="button"
      class={`sound ${heard ? "" : "silent"}`}
      aria-pressed={heard}
      title={t(heard ? "sound.heard" : "sound.press")}
      onClick={() => switchSound(!heard)}
    >
      <Icon name={heard ? "bell" : "bellOff"} /> {word}
    </button>
  );
}
