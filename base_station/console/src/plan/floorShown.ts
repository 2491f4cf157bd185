/** The initial floor of a picture. */
import { effect } from "@preact/signals";
import { floor, type FloorChoice } from "../uiState";
import type { Picture } from "../live/picture";
import { firstFloor, floorsOf } from "./floors";

/** After a replay the live plan is shown as before. */
const leftAt = new WeakMap<Picture, FloorChoice>();

/** The last shown floor; else the initial one as soon as people are located.  After that, and before, the
 * user chooses.  The returned function ends it. */
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
