import { openDialog } from "../uiState";
import { confirmationWords, parOf, rollCall, type ParState } from "../live/duty";
import type { Picture } from "../live/picture";
import type { UnitView } from "../wire";
import { countdown, timeLeft } from "../format";
import { t } from "../language/translate";
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
  const words =
    call.overdue > 0
      ? t("par.overdue_count", { count: call.overdue })
      : t("par.due_header", { time: timeLeft(call.leftMs) });
  return (
    <button
      type="button"
      class={`par-clock ${call.state}`}
      onClick={() => openDialog("roll_call")}
    >
      <Icon name={ICONS[call.state]} />
      <span class="par-words">
        <span>{words}</span>
        {call.unconfirmed > 0 && <small>{t("par.unconfirmed_count", { count: call.unconfirmed })}</small>}
      </span>
    </button>
  );
}

/** Whether the mark of this person shows it. */
export function isOverdue({ unit_id, duty }: UnitView, picture: Picture): boolean {
  if (duty === null) return false;
  return parOf(duty, picture.incident.value, picture.nowMsOf(unit_id)).state === "overdue";
}

interface MarkProps {
  unit: UnitView;
  picture: Picture;
  brief?: boolean; // beside the words about the confirmation
  isShort?: boolean; // the time alone, where a name and an alarm need the room; its words are in the title
}

/** On a card: how long until this member's PAR is due, and whether any was confirmed. */
export function ParMark({ unit, picture, brief = false, isShort = false }: MarkProps) {
  const { duty } = unit;
  if (duty === null) return null;
  const { state, leftMs } = parOf(duty, picture.incident.value, picture.nowMsOf(unit.unit_id));
  const words = markWords(state, duty.asked_ms !== null, leftMs);
  const confirmation = t("par.state", { state: confirmationWords(duty) });
  return (
    <span class={`par-mark ${state}`} title={isShort ? `${words}. ${confirmation}` : confirmation}>
      <Icon name={ICONS[state]} />
      {isShort ? shortWords(state, leftMs) : words}
      {!brief && duty.confirmed === "not_yet" && <small>{t("par.unconfirmed")}</small>}
    </span>
  );
}

function markWords(state: ParState, isRequested: boolean, leftMs: number): string {
  if (state === "overdue") return t("par.overdue", { time: countdown(-leftMs) });
  return isRequested
    ? t("par.requested", { time: countdown(leftMs) })
    : t("par.due", { time: timeLeft(leftMs) });
}

function shortWords(state: ParState, leftMs: number): string {
  return state === "overdue"
    ? t("par.overdue_short", { time: countdown(-leftMs) })
    : t("par.due_short", { time: timeLeft(leftMs) });
}
