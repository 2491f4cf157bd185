/** What units were told, as the screen needs it.  Pure. */
import type { CommandView, DeliveryState, DeliveryView, IncidentView, UnitView } from "../wire";

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

/** Those of the incident that is open, or of none while none is, and whatever is still on its way:
 * the orders of a closed incident stay in it. */
export function current(
  commands: Iterable<CommandView>,
  incident: IncidentView | null,
): CommandView[] {
  const openId = incident === null || incident.closed_ms !== null ? "" : incident.incident_id;
  return [...commands].filter((command) => command.open || command.incident_id === openId);
}

/** The newest first. */
export function newestFirst(commands: Iterable<CommandView>): CommandView[] {
  return [...commands].sort((a, b) => b.issued_ms - a.issued_ms);
}

/** How many units have done their part, and of how many. */
export function answered(command: CommandView): [done: number, all: number] {
  const end = doneState(command);
  return [command.units.filter((one) => one.state === end).length, command.units.length];
}

/** Of an order, those that are not done first; else in the order given. */
export function unansweredFirst(command: CommandView): DeliveryView[] {
  const end = doneState(command);
  return [...command.units].sort((a, b) => Number(a.state === end) - Number(b.state === end));
}

/** "2 of 5 acknowledged". */
export function progress(command: CommandView): string {
  const [done, all] = answered(command);
  return `${done} of ${all} ${stateWord(doneState(command))}`;
}

function doneState(command: CommandView): DeliveryState {
  return command.asks_wearer ? "acknowledged" : "received";
}

/** The crews that somebody on duty belongs to. */
export function crewsOf(units: Iterable<UnitView>): string[] {
  const crews = [...units].map((unit) => unit.person?.crew ?? "");
  return [...new Set(crews)].filter((crew) => crew !== "").sort();
}

export type Target = { everyone: true } | { crew: string } | { unit_id: string };

const KINDS: Record<string, string> = {
  evacuate: "Evacuate",
  par_request: "PAR",
  text: "Message",
  locate: "Locate",
  set_position_rate: "Position rate",
};

export function kindWord(kind: string): string {
  return KINDS[kind] ?? kind;
}

/** What a locate order does: no unit has a light or a sounder yet. */
export const LOCATE_HINT = 
  "Shown as received by the unit once it is there. No unit has a sounder or a light yet.";

/** "PAR", "Message: come out". */
export function commandWord(command: CommandView): string {
  const word = kindWord(command.kind);
  return command.text === "" ? word : `${word}: ${command.text}`;
}

const STATES: Record<DeliveryState, string> = {
  queued: "not reached yet",
  sent: "sent",
  received: "received by the unit",
  acknowledged: "acknowledged",
  refused: "refused",
  expired: "no answer",
};

export function stateWord(state: DeliveryState): string {
  return STATES[state];
}
