/** Commands to units, for display.  Pure. */
import type { CommandView, DeliveryState, DeliveryView, IncidentView, UnitView } from "../wire";
import { clockTime } from "../format";
import { compareNames } from "../language/measures";
import { label, t } from "../language/translate";
import { nameAmong } from "./urgency";

export interface UnitCommand {
  command: CommandView;
  delivery: DeliveryView;
}

/** The open commands to a unit, in the order given. */
export function openTo(unitId: string, commands: Iterable<CommandView>): UnitCommand[] {
  return [...commands].flatMap((command) =>
    command.open
      ? command.units
          .filter((delivery) => delivery.unit_id === unitId)
          .map((delivery) => ({ command, delivery }))
      : [],
  );
}

/** Orders of the open incident, or of none while none is open, and those still being delivered: orders of
 * a closed incident are not shown. */
export function current(
  commands: Iterable<CommandView>,
  incident: IncidentView | null,
): CommandView[] {
  const openId = incident === null || incident.closed_ms !== null ? "" : incident.incident_id;
  return [...commands].filter((command) => command.open || command.incident_id === openId);
}

/** Whether it is an evacuation that no all clear has ended, answered by all or not. */
export function stands(command: CommandView): boolean {
  return command.kind === "evacuate" && command.ended_ms === null;
}

/** Orders that are open or stand, an evacuation first, then the newest. */
export function underWay(commands: Iterable<CommandView>): CommandView[] {
  const open = newestFirst(commands).filter((command) => command.open || stands(command));
  return [...open.filter(stands), ...open.filter((command) => !stands(command))];
}

/** Members without an answer to an order that can be sent again. */
export function unanswered(command: CommandView): DeliveryView[] {
  if (!command.asks_wearer || command.ended_ms !== null) return [];
  return command.units.filter((one) => one.state !== "acknowledged");
}

/** The newest locate order to a unit. */
export function lastLocate(unitId: string, commands: Iterable<CommandView>): UnitCommand | null {
  const [last] = newestFirst(commands).filter(
    (command) => command.kind === "locate" && command.units.some((one) => one.unit_id === unitId),
  );
  const delivery = last?.units.find((one) => one.unit_id === unitId);
  return last === undefined || delivery === undefined ? null : { command: last, delivery };
}

/** The newest first. */
export function newestFirst(commands: Iterable<CommandView>): CommandView[] {
  return [...commands].sort((a, b) => b.issued_ms - a.issued_ms);
}

/** Number of units that have completed the order, and of its recipients. */
export function answered(command: CommandView): [done: number, all: number] {
  return [command.units.filter((one) => isDone(command, one)).length, command.units.length];
}

/** Recipients of an order: those reachable only by voice radio first, completed ones last, else in the
 * order given. */
export function unansweredFirst(command: CommandView): DeliveryView[] {
  const rank = (one: DeliveryView) =>
    isDone(command, one) ? 2 : shownState(command, one) === CANNOT_BE_NOTIFIED ? 0 : 1;
  return [...command.units].sort((a, b) => rank(a) - rank(b));
}

/** "2 of 5 acknowledged, 1 cannot be notified". */
export function progress(command: CommandView): string {
  const [done, all] = answered(command);
  const words = t("order.progress", { done, all, state: stateWord(doneState(command)) });
  const states = command.units.map((one) => shownState(command, one));
  const cannot = states.filter((state) => state === CANNOT_BE_NOTIFIED).length;
  return cannot === 0 ? words : t("order.progress_cannot", { progress: words, count: cannot });
}

/** An answer by radio completes an order like any signal. */
function isDone(command: CommandView, { state }: DeliveryView): boolean {
  return state === doneState(command) || state === "acknowledged";
}

function doneState(command: CommandView): DeliveryState {
  if (command.asks_wearer) return "acknowledged";
  return command.notifies_wearer ? "notified" : "received";
}

export const CANNOT_BE_NOTIFIED = "cannot_be_notified";
export type ShownState = DeliveryState | typeof CANNOT_BE_NOTIFIED | "ended";

/** At a unit without an output no state of delivery means that its wearer is notified. */
export function shownState(command: CommandView, delivery: DeliveryView): ShownState {
  const { state, can_be_notified } = delivery;
  if (state === "expired" && command.kind === "evacuate" && command.ended_ms !== null) return "ended";
  // A unit of an earlier version does not know it, and only the radio reaches its wearer.
  if (state === "refused" && command.kind === "all_clear") return CANNOT_BE_NOTIFIED;
  const answered = state === "notified" || state === "acknowledged" || state === "refused";
  if (answered || !command.notifies_wearer || can_be_notified !== false) return state;
  return CANNOT_BE_NOTIFIED;
}

/** Whether an answer by voice radio is still possible: an order that only signals is complete once the
 * unit signals. */
export function mayAnswerByRadio(command: CommandView, delivery: DeliveryView): boolean {
  if (command.kind === "evacuate" && command.ended_ms !== null) return false;
  return command.asks_wearer || (command.notifies_wearer && delivery.state !== "notified");
}

/** Crews with members on duty. */
export function crewsOf(units: Iterable<UnitView>): string[] {
  const crews = [...units].map((unit) => unit.person?.crew ?? "");
  return [...new Set(crews)].filter((crew) => crew !== "").sort(compareNames);
}

export type Target = { everyone: true } | { crew: string } | { floor: number } | { unit_id: string };

/** Recipients of an order, as the station decides them. */
export function recipients(target: Target, units: readonly UnitView[]): UnitView[] {
  const ours = units.filter((unit) => unit.registered);
  if ("unit_id" in target) return ours.filter((unit) => unit.unit_id === target.unit_id);
  if ("floor" in target) return ours.filter((unit) => mayBeOn(unit, target.floor));
  if ("crew" in target) return ours.filter((unit) => unit.person?.crew === target.crew);
  return ours.filter(
    (unit) => unit.person !== null || (unit.last_heard_ms !== null && !unit.switched_off),
  );
}

/** Members whose floor is unknown may be on it. */
function mayBeOn({ person, position }: UnitView, floor: number): boolean {
  const on = position?.floor ?? null;
  return person !== null && (on === null || on === floor);
}

/** Floors with people on them, the highest first. */
export function floorsOf(units: Iterable<UnitView>): number[] {
  const floors = [...units].map((unit) => unit.position?.floor ?? null);
  return [...new Set(floors)].filter((floor) => floor !== null).sort((a, b) => b - a);
}

/** "2 of 5 cannot be notified: use the voice radio", and their names; no names if it is all of several;
 * null: as far as is known, all can be notified. */
export function notNotifiable(target: Target, units: readonly UnitView[]): { words: string; names: string[] } | null {
  const all = recipients(target, units);
  const cannot = all.filter((unit) => unit.can_be_notified === false);
  if (cannot.length === 0) return null;
  const words = t("order.cannot", { count: cannot.length, all: all.length });
  const isAll = cannot.length === all.length && all.length > 1;
  return { words, names: isAll ? [] : cannot.map((unit) => nameAmong(unit, units)) };
}

export function kindWord(kind: string): string {
  return label("order", kind);
}

/** "PAR", "Message: come out". */
export function commandWord(command: CommandView): string {
  const word = kindWord(command.kind);
  return command.text === "" ? word : t("order.with_text", { order: word, text: command.text });
}

/** Progress of an order with one member, in words. */
export function deliveryWord(command: CommandView, delivery: DeliveryView): string {
  return locateWord(command, delivery) ?? stateWord(shownState(command, delivery));
}

/** State of a unit that was ordered to signal its place; null: none yet, or another order. */
function locateWord(command: CommandView, delivery: DeliveryView): string | null {
  const { acknowledged_ms: stoppedMs, acknowledged_via: via, notified_ms: sinceMs, ended_ms: endedMs } = delivery;
  if (command.kind !== "locate") return null;
  if (stoppedMs !== null && via === "self") return t("order.locate_stopped_by_wearer", { time: clockTime(stoppedMs) });
  if (stoppedMs !== null) return null;
  if (delivery.can_be_notified === false) return t("order.locate_no_sounder");
  if (command.ended_ms !== null && delivery.sent_ms !== null) {
    return endedMs === null ? t("order.locate_stopping") : t("order.locate_stopped", { time: clockTime(endedMs) });
  }
  if (sinceMs === null) return null;
  if (!command.open) return t("order.locate_until", { time: clockTime(command.expires_ms) });
  return t(SIGNALS[delivery.signal], { time: clockTime(sinceMs) });
}

const SIGNALS = {
  sound: "order.locate_sounds",
  light: "order.locate_lights",
  "": "order.locate_signals", // by a unit of an earlier version
} as const;

export function stateWord(state: ShownState): string {
  return t(`delivery.${state}`);
}
