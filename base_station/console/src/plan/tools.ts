/** Tools of the plan: one at a time, begun with a button, ended with Escape. */
import { signal } from "@preact/signals";
import { pane } from "../uiState";

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
  | { kind: "edit-beacon"; beaconId: string }
  | { kind: "trails" } // which are drawn
  | { kind: "pins" }; // all of them, in words

export const tool = signal<Tool | null>(null);
/** Points clicked since the tool was chosen. */
export const clicked = signal<readonly Place[]>([]);

export function take(next: Tool): void {
  clicked.value = [];
  tool.value = next;
  pane.value = "plan";
}

export function putDown(): void {
  clicked.value = [];
  tool.value = null;
}

/** Ends the tool if it is active, else starts it. */
export function toggle(next: Tool): void {
  if (tool.peek()?.kind === next.kind) putDown();
  else take(next);
}

const WITHOUT_PLACE: readonly Tool["kind"][] = ["meeting", "trails", "pins"];

/** Whether a click on the plan gives a point to the tool. */
export function wantsPlaces(now: Tool | null): boolean {
  return now !== null && !WITHOUT_PLACE.includes(now.kind);
}

/** A click on the plan: the anchor needs two places, the others take the last. */
export function click(place: Place): void {
  const before = clicked.peek();
  const needed = tool.peek()?.kind === "anchor" ? 2 : 1;
  clicked.value = needed === 1 ? [place] : before.length < 2 ? [...before, place] : [place];
}
