import { soundBlocked, soundOn, switchSound } from "../sound";
import { Icon } from "./Icon";

/** Whether alarms are heard at this console. */
export function SoundButton() {
  const heard = soundOn.value && !soundBlocked.value;
  const word = !soundOn.value ? "Sound off" : heard ? "Sound on" : "No sound yet";
  return (
    <button
      type="button"
      class={`sound ${heard ? "" : "silent"}`}
      aria-pressed={heard}
      title={heard ? "Alarms are heard" : "Press to hear alarms"}
      onClick={() => switchSound(!heard)}
    >
      <Icon name={heard ? "bell" : "bellOff"} /> {word}
    </button>
  );
}
