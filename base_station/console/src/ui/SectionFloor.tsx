import type { Signal } from "@preact/signals";
import { t } from "../language/translate";
import type { Picture } from "../live/picture";
import type { DrawnMark } from "../section/markDrawing";
import { floor, select } from "../uiState";
import { Mark, MarkMembers } from "./SectionMark";

interface MarkedFloor {
  floor: number | null; // null: of those whose floor nobody knows
  name: string;
  short: string;
  height: string;
  marks: readonly DrawnMark[];
}

interface FloorProps {
  floor: MarkedFloor;
  label: { top: string; left?: string }; // where its name stands
  narrow: boolean; // short names
  open: Signal<string | null>; // the mark whose people are listed
}

/** A floor with its people: entry of the list that screen readers get in place of the drawing. */
export function SectionFloor({ floor: one, label, narrow, open }: FloorProps) {
  const people = one.marks.reduce((count, { members }) => count + members.length, 0);
  return (
    <li class={one.floor !== null && one.floor === floor.value ? "shown" : ""}>
      <span class={one.floor === null ? "spoken" : "section-floor"} style={label}>
        {narrow && <span aria-hidden="true">{one.short}</span>}
        <span class={narrow ? "spoken" : ""}>{one.name}</span>
        {!narrow && <small>{one.height}</small>}
        <span class="spoken">{t("section.people_on", { count: people })}</span>
      </span>
      <ul>
        {one.marks.map((mark) => (
          <li key={mark.key}>
            <Mark mark={mark} isOpen={open.value === mark.key} press={() => press(mark, open)} />
          </li>
        ))}
      </ul>
    </li>
  );
}

function press(mark: DrawnMark, open: Signal<string | null>): void {
  const [single] = mark.members;
  if (mark.members.length > 1) open.value = open.value === mark.key ? null : mark.key;
  else if (single !== undefined) select(single.unitId, null);
}

interface OpenProps {
  floors: readonly MarkedFloor[];
  open: Signal<string | null>;
}

/** The people of the number that is open. */
export function OpenMark({ floors, open }: OpenProps) {
  const mark = floors.flatMap(({ marks }) => marks).find(({ key }) => key === open.value);
  if (mark === undefined || mark.members.length < 2) return null;
  return <MarkMembers mark={mark} close={() => (open.value = null)} />;
}

/** People without a known height; they are not in the drawing. */
export function NotLocated({ picture }: { picture: Picture }) {
  void picture.unitsChanged.value;
  const count = picture.allUnits().filter(({ position }) => position === null).length;
  return count === 0 ? null : <p class="section-missing">{t("section.not_located", { count })}</p>;
}
