/** The initial floor of a picture. */
import { effect } from "@preact/signals";
import { floor, type FloorChoice } from "../uiState";
import type { Picture } from "../live/picture";
import { firstFloor, floorsOf } from "./floors";

/** Who comes back from a replay finds the live plan as it was left. */
const leftAt = new WeakMap<Picture, FloorChoice>();

/** Where it was left; else the first floor as soon as somebody is on one.  After that, and where there
 * is nobody yet, the person chooses.  The result ends it. */
export function beginOnAFloor(picture: Picture): () => void {
  const before = leftAt.get(picture);
  if (before !== undefined) floor.value = before;
  const atFirst = floor.peek();
  let settled = before !== undefined;
  const end = effect(() => {
    void picture.unitsChanged.value;
    settled ||= floor.value !== atFirst;
    if (settled) return;
    const floors = floorsOf(picture.plan.value, picture.allUnits(), new Map());
    const first = firstFloor(floors);
    if (first === null || !floors.some((one) => one.people > 0)) return;
    settled = true;
    floor.value = first;
  });
  return () => {
    end();
    if (settled) leftAt.set(picture, floor.peek());
  };
}
