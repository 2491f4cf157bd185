import { useRef } from "preact/hooks";
import { attempt, isPast, mayAct } from "../sessions";
import { find } from "../uiState";
import * as api from "../api";
import { handedTo, sinceMs } from "../live/alarms";
import { alarmCurrentValue } from "../live/alarmCurrentValue";
import type { Picture } from "../live/picture";
import type { AlarmView } from "../wire";
import { duration } from "../format";
import { ConfirmButton } from "./ConfirmButton";
import { ErrorBoundary } from "./ErrorBoundary";
import { useGuardedPress } from "./useGuardedPress";
import { Icon } from "./Icon";
import { SoundButton } from "./SoundButton";

const PRIORITY: Record<number, string> = { 1: "Immediate", 2: "Soon", 3: "Information" };

export function AlarmStrip({ picture }: { picture: Picture }) {
  const alarms = picture.openAlarms.value;
  return (
    <section class="alarms" aria-label="Open alarms">
      <div class="alarms-head">
        <h2>{alarms.length === 0 ? "No open alarms" : `${alarms.length} open`}</h2>
        {!isPast.value && <SoundButton />}
      </div>
      <ul aria-live="assertive" aria-relevant="additions">
        {alarms.map((alarm, place) => (
          <ErrorBoundary as="li" key={alarm.alarm_id} what={`The alarm "${alarm.text}"`}>
            <AlarmRow alarm={alarm} place={place} picture={picture} />
          </ErrorBoundary>
        ))}
      </ul>
    </section>
  );
}

interface RowProps {
  alarm: AlarmView;
  place: number; // in the list
  picture: Picture;
}

function AlarmRow({ alarm, place, picture }: RowProps) {
  const taken = alarm.state === "acknowledged";
  const unit = picture.unit(alarm.unit_id);
  const handed = unit === undefined ? "" : handedTo(alarm, unit.value);
  const nowMs = picture.nowMs.value;
  const figure =
    unit === undefined ? "" : alarmCurrentValue(alarm, unit.value, nowMs, picture.silentMs.value > 0);
  return (
    <li class={`alarm p${alarm.priority} ${taken ? "taken" : ""}`} data-alarm={alarm.alarm_id}>
      <Icon name={taken ? "check" : "alarm"} />
      <span class="priority">{PRIORITY[alarm.priority] ?? `Priority ${alarm.priority}`}</span>
      <button
        type="button"
        class="what"
        title="Show on the plan"
        disabled={unit === undefined}
        onClick={() => find(alarm.unit_id, unit?.peek().position?.floor ?? null)}
      >
        {alarm.text}
        {handed !== "" && ` (${handed})`}
      </button>
      <span class="since" aria-live="off">
        {duration(nowMs - sinceMs(alarm))} ago{" "}
        {figure !== "" && <strong>{figure}</strong>}
      </span>
      <State words={stateOf(alarm, mayAct.value)} />
      {mayAct.value && <AlarmAction alarm={alarm} place={place} />}
    </li>
  );
}

/** A long name is cut; all of it is said to who points at it. */
function State({ words }: { words: string }) {
  return (
    <span class="state" title={words}>
      {words}
    </span>
  );
}

/** Where there is a button to acknowledge, it says that nobody has. */
function stateOf(alarm: AlarmView, hasButton: boolean): string {
  if (alarm.state === "acknowledged") return `acknowledged by ${alarm.by}`;
  return hasButton ? "" : "not acknowledged";
}

/** To resolve asks first: it stands where the button to acknowledge was a moment ago. */
function AlarmAction({ alarm, place }: Omit<RowProps, "picture">) {
  const steady = useGuardedPress(place);
  const pressed = useRef(false);
  if (alarm.state === "acknowledged") {
    return (
      <ConfirmButton
        label="Resolve"
        about={alarm.text}
        question="Is it over?"
        focused={pressed.current}
        onConfirm={steady(() => void attempt(api.resolve(alarm)))}
      />
    );
  }
  return (
    <button
      type="button"
      class="act"
      aria-label={`Acknowledge: ${alarm.text}`}
      onClick={steady(() => {
        pressed.current = true;
        void attempt(api.acknowledge(alarm));
      })}
    >
      Acknowledge
    </button>
  );
}
