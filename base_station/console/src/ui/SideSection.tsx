import { useComputed, useSignal, useSignalEffect } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { t } from "../language/translate";
import type { Picture } from "../live/picture";
import { AXES } from "../section/axis";
import type { DrawnSection } from "../section/drawing";
import { followSection, NARROW_PX, type Window } from "../section/follow";
import { axis } from "../section/shown";
import { selectedUnit } from "../uiState";
import { SectionGround } from "./SectionGround";
import { Choice } from "./Choice";
import { NotLocated, OpenMark, SectionFloor } from "./SectionFloor";
import { SectionView } from "./SectionView";

/** Side view of the building with people at their heights.  For screen readers it is a list of floors. */
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
  return (
    <section class="section" aria-label={t("section.title")}>
      <div class="section-view" ref={view}>
        {section !== null && (
          <div class="section-sheet" style={{ height: `${section.heightPx}px` }}>
            <SectionGround section={section} widthPx={window.value.widthPx} />
            <ul aria-label={t("section.floors")}>
              {section.floors.map((one) => (
                <SectionFloor
                  key={one.floor}
                  floor={one}
                  label={{ top: `${one.bottomPx}px` }}
                  narrow={narrow.value}
                  open={open}
                />
              ))}
            </ul>
          </div>
        )}
      </div>
      {section !== null && (
        <div class="section-ends">
          <span>◂ {section.left}</span>
          <div class="section-choices">
            <Choice
              label={t("section.axis")}
              choices={AXES}
              chosen={axis}
              textOf={(one) => t(`section.axis_${one}`)}
            />
            <SectionView />
          </div>
          <span>{section.right} ▸</span>
          <p class="quiet">{t("section.legend")}</p>
        </div>
      )}
      <OpenMark floors={section?.floors ?? []} open={open} />
      <NotLocated picture={picture} />
    </section>
  );
}

/** The chosen member or one in danger, if the window is too low for all floors. */
function showInNeed(view: HTMLElement | null): void {
  const marks = [".section-mark.chosen", ".section-mark.immediate", ".shown > .section-floor"];
  const first = marks.map((one) => view?.querySelector(one)).find((one) => one !== null);
  first?.scrollIntoView({ block: "nearest" });
}
