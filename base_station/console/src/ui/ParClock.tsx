import { openDialog } from "../uiState";
import { confirmationWords, parOf, rollCall, type ParState } from "../live/duty";
import type { Picture } from "../live/picture";
import type { UnitView } from "../wire";
import { countdown } from "../format";
import { Icon, type IconName } from "./Icon";

const ICONS: Record<ParState, IconName> = {
  green: "check",
  unconfirmed: "clock",
  warning: "clock",
  overdue: "alarm",
};

/** In the header: when the next PAR is due, big enough for the other side of the vehicle. */
export function ParClock({ picture }: { picture: Picture }) {
  void picture.unitsChanged.value;
  const call = rollCall(picture.allUnits(), picture.incident.value, picture.nowMs.value);
  if (call === null) return null;
  const words = call.overdue > 0 ? `${call.overdue} overdue` : countdown(call.leftMs);
  return (
    <button
      type="button"
      class={`par-clock ${call.state}`}
      onClick={() => openDialog("roll_call")}
    >
      <Icon name={ICONS[call.state]} />
      <span class="par-words">
        <span>PAR {words}</span>
        <span class="spoken">{call.overdue > 0 ? "" : " until the next PAR"}</span>
        {call.unconfirmed > 0 && <small>{call.unconfirmed} not yet confirmed</small>}
      </span>
    </button>
  );
}

/** Whether the mark of this person says so. */
export function isOverdue({ duty }: UnitView, picture: Picture): boolean {
  if (duty === null) return false;
  return parOf(duty, picture.incident.value, picture.nowMs.value).state === "overdue";
}

interface MarkProps {
  unit: UnitView;
  picture: Picture;
  brief?: boolean; // beside the words about the confirmation
}

/** On a card: how long until this member's PAR is due, and whether any was confirmed. */
export function ParMark({ unit, picture, brief = false }: MarkProps) {
  const { duty } = unit;
  if (duty === null) return null;
  const { state, leftMs } = parOf(duty, picture.incident.value, picture.nowMs.value);
  const word = state === "overdue" ? `${countdown(-leftMs)} over` : countdown(leftMs);
  return (
    <span class={`par-mark ${state}`} title={`PAR ${confirmationWords(duty)}`}>
      <Icon name={ICONS[state]} />
      {duty.asked_ms !== null && state !== "overdue" ? "PAR asked" : "PAR"} {word}
      {!brief && duty.confirmed === "not_yet" && <small>not yet confirmed</small>}
    </span>
  );
}
