import { useSignal } from "@preact/signals";
import { attempt, isPast, mayAct } from "../sessions";
import { select } from "../view";
import * as api from "../api";
import { useBeeper } from "../sound";
import type { Picture } from "../live/picture";
import type { AlarmView } from "../wire";
import { duration } from "../words";
import { Icon } from "./Icon";

const PRIORITY: Record<number, string> = { 1: "Immediate", 2: "Soon", 3: "Information" };

export function AlarmStrip({ picture }: { picture: Picture }) {
  const sound = useSignal(false);
  const alarms = picture.openAlarms.value;
  useBeeper(sound.value && !isPast.value, alarms);
  return (
    <section class="alarms" aria-label="Open alarms">
      <div class="alarms-head">
        <h2>{alarms.length === 0 ? "No open alarms" : `${alarms.length} open`}</h2>
        {!isPast.value && (
          <button
            type="button"
            class="sound"
            aria-pressed={sound.value}
            onClick={() => (sound.value = !sound.value)}
          >
            <Icon name={sound.value ? "bell" : "bellOff"} /> Sound {sound.value ? "on" : "off"}
          </button>
        )}
      </div>
      <ul aria-live="assertive" aria-relevant="additions">
        {alarms.map((alarm) => (
          <AlarmRow key={alarm.alarm_id} alarm={alarm} picture={picture} />
        ))}
      </ul>
    </section>
  );
}

interface RowProps {
  alarm: AlarmView;
  picture: Picture;
}

function AlarmRow({ alarm, picture }: RowProps) {
  const taken = alarm.state === "acknowledged";
  const unit = picture.unit(alarm.unit_id);
  return (
    <li class={`alarm p${alarm.priority} ${taken ? "taken" : ""}`} data-alarm={alarm.alarm_id}>
      <Icon name={taken ? "check" : "alarm"} />
      <span class="priority">{PRIORITY[alarm.priority] ?? `Priority ${alarm.priority}`}</span>
      <button
        type="button"
        class="what"
        title="Show on the plan"
        disabled={unit === undefined}
        onClick={() => select(alarm.unit_id, unit?.peek().position?.floor ?? null)}
      >
        {alarm.text}
      </button>
      <span class="for" aria-live="off">
        for {duration(picture.nowMs.value - alarm.raised_ms)}
      </span>
      <span class="state">{stateOf(alarm, mayAct.value)}</span>
      {mayAct.value && <AlarmAction alarm={alarm} />}
    </li>
  );
}

/** Where there is a button to acknowledge, it says that nobody has. */
function stateOf(alarm: AlarmView, hasButton: boolean): string {
  if (alarm.state === "acknowledged") return `acknowledged by ${alarm.by}`;
  return hasButton ? "" : "not acknowledged";
}

function AlarmAction({ alarm }: { alarm: AlarmView }) {
  const taken = alarm.state === "acknowledged";
  const send = () => (taken ? api.resolve(alarm.alarm_id) : api.acknowledge(alarm.alarm_id));
  const word = taken ? "Resolve" : "Acknowledge";
  return (
    <button
      type="button"
      class="act"
      aria-label={`${word}: ${alarm.text}`}
      onClick={() => void attempt(send())}
    >
      {word}
    </button>
  );
}
