import { useComputed, useSignal, useSignalEffect } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { t } from "../language/translate";
import type { Picture } from "../live/picture";
import { AXES, type AxisChoice } from "../section/axis";
import type { DrawnFloor, DrawnSection } from "../section/drawing";
import type { DrawnMark } from "../section/markDrawing";
import { followSection, NARROW_PX, type Window } from "../section/follow";
import { axis } from "../section/shown";
import { floor, select, selectedUnit } from "../uiState";
import { SectionGround } from "./SectionGround";
import { Mark, MarkMembers } from "./SectionMark";

/** The building from its side: everybody at their height.  Read aloud it is a list of floors. */
export function SideSection({ picture }: { picture: Picture }) {
  const view = useRef<HTMLDivElement>(null);
  const window = useSignal<Window>({ widthPx: 0, heightPx: 0 });
  const drawn = useSignal<DrawnSection | null>(null);
  const open = useSignal<string | null>(null); // the mark whose people are listed
  useEffect(() => followSection(picture, window, drawn), [picture]);
  useEffect(() => {
    const element = view.current;
    if (element === null) return undefined;
    const observer = new ResizeObserver(() => {
      window.value = { widthPx: element.clientWidth, heightPx: element.clientHeight };
    });
    observer.observe(element);
    return () => observer.disconnect();
  }, []);
  const isDrawn = useComputed(() => drawn.value !== null);
  useSignalEffect(() => {
    void selectedUnit.value;
    if (isDrawn.value) requestAnimationFrame(() => showInNeed(view.current));
  });
  const narrow = useComputed(() => window.value.widthPx < NARROW_PX);
  const section = drawn.value;
  const opened = section?.floors.flatMap(({ marks }) => marks).find(({ key }) => key === open.value);
  return (
    <section class="section" aria-label={t("section.title")}>
      <div class="section-view" ref={view}>
        {section !== null && (
          <div class="section-sheet" style={{ height: `${section.heightPx}px` }}>
            <SectionGround section={section} widthPx={window.value.widthPx} />
            <ul aria-label={t("section.floors")}>
              {section.floors.map((one) => (
                <Floor
                  key={one.floor}
                  floor={one}
                  narrow={narrow.value}
                  openMark={opened === undefined ? null : open.value}
                  press={(mark) => {
                    const [single] = mark.members;
                    if (mark.members.length > 1) open.value = open.value === mark.key ? null : mark.key;
                    else if (single !== undefined) select(single.unitId, null);
                  }}
                />
              ))}
            </ul>
          </div>
        )}
      </div>
      {section !== null && (
        <div class="section-ends">
          <span>◂ {section.left}</span>
          <AxisChooser />
          <span>{section.right} ▸</span>
          <p class="quiet">{t("section.legend")}</p>
        </div>
      )}
      {opened !== undefined && opened.members.length > 1 && (
        <MarkMembers mark={opened} close={() => (open.value = null)} />
      )}
      <NotLocated picture={picture} />
    </section>
  );
}

function AxisChooser() {
  return (
    <label>
      <span>{t("section.axis")}</span>
      <select
        aria-label={t("section.axis")}
        value={axis.value}
        onChange={(event) => (axis.value = event.currentTarget.value as AxisChoice)}
      >
        {AXES.map((one) => (
          <option key={one} value={one}>
            {t(`section.axis_${one}`)}
          </option>
        ))}
      </select>
    </label>
  );
}

/** Who is chosen or in danger, where the window is too low for all floors. */
function showInNeed(view: HTMLElement | null): void {
  const marks = [".section-mark.chosen", ".section-mark.immediate", ".shown > .section-floor"];
  const first = marks.map((one) => view?.querySelector(one)).find((one) => one !== null);
  first?.scrollIntoView({ block: "nearest" });
}

interface FloorProps {
  floor: DrawnFloor;
  narrow: boolean;
  openMark: string | null;
  press(mark: DrawnMark): void;
}

function Floor({ floor: one, narrow, openMark, press }: FloorProps) {
  const people = one.marks.reduce((count, { members }) => count + members.length, 0);
  return (
    <li class={one.floor !== null && one.floor === floor.value ? "shown" : ""}>
      <span class={one.floor === null ? "spoken" : "section-floor"} style={{ top: `${one.bottomPx}px` }}>
        {narrow && <span aria-hidden="true">{one.short}</span>}
        <span class={narrow ? "spoken" : ""}>{one.name}</span>
        {!narrow && <small>{one.height}</small>}
        <span class="spoken">{t("section.people_on", { count: people })}</span>
      </span>
      <ul>
        {one.marks.map((mark) => (
          <li key={mark.key}>
            <Mark mark={mark} isOpen={openMark === mark.key} press={() => press(mark)} />
          </li>
        ))}
      </ul>
    </li>
  );
}

/** Of whom no height is known; they are in no place of the drawing. */
function NotLocated({ picture }: { picture: Picture }) {
  void picture.unitsChanged.value;
  const count = picture.allUnits().filter(({ position }) => position === null).length;
  return count === 0 ? null : <p class="section-missing">{t("section.not_located", { count })}</p>;
}
