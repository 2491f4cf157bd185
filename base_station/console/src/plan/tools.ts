/** What is being done on the plan: one thing at a time, begun with a button, ended with Escape. */
import { signal } from "@preact/signals";

/** Metres in the incident frame. */
export interface Place {
  north_m: number;
  east_m: number;
}

export type Tool =
  | { kind: "pin"; unitId: string } // somebody is or was here
  | { kind: "start" } // all of them began here
  | { kind: "meeting"; unitId: string }
  | { kind: "beacon" }
  | { kind: "anchor" } // where two points of the plan are on the Earth
  | { kind: "edit-pin"; pinId: string }
  | { kind: "edit-beacon"; beaconId: string };

export const tool = signal<Tool | null>(null);
/** Where the person has clicked since the tool was taken. */
export const clicked = signal<readonly Place[]>([]);

export function take(next: Tool): void {
  clicked.value = [];
  tool.value = next;
}

export function putDown(): void {
  clicked.value = [];
  tool.value = null;
}

/** Whether a click on the plan says a place to the tool. */
export function wantsPlaces(): boolean {
  const kind = tool.peek()?.kind;
  return kind !== undefined && kind !== "meeting";
}

/** A click on the plan: the anchor needs two places, the others take the last. */
export function click(place: Place): void {
  const before = clicked.peek();
  const needed = tool.peek()?.kind === "anchor" ? 2 : 1;
  clicked.value = needed === 1 ? [place] : before.length < 2 ? [...before, place] : [place];
}
