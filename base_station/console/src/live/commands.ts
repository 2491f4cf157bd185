/** What units were told, as the screen needs it.  Pure. */
import type { CommandView, DeliveryState, DeliveryView, UnitView } from "../wire";

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

/** The newest first. */
export function newestFirst(commands: Iterable<CommandView>): CommandView[] {
  return [...commands].sort((a, b) => b.issued_ms - a.issued_ms);
}

/** How many units have done their part, and of how many. */
export function answered(command: CommandView): [done: number, all: number] {
  const end: DeliveryState = command.asks_wearer ? "acknowledged" : "received";
  return [command.units.filter((one) => one.state === end).length, command.units.length];
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

/** "PAR", "Message: come out". */
export function commandWord(command: CommandView): string {
  const word = kindWord(command.kind);
  return command.text === "" ? word : `${word}: ${command.text}`;
}

const STATES: Record<DeliveryState, string> = {
  queued: "not reached yet",
  sent: "sent",
  received: "received",
  acknowledged: "acknowledged",
  refused: "refused",
  expired: "no answer",
};

export function stateWord(state: DeliveryState): string {
  return STATES[state];
}
