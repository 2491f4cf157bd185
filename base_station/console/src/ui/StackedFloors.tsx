import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { t } from "../language/translate";
import type { Picture } from "../live/picture";
import type { Window } from "../section/follow";
import { SPREADS, spread } from "../section/shown";
import type { DrawnStack } from "../stack/drawing";
import type { StackView } from "../stack/follow";
import { Choice } from "./Choice";
import { NotLocated, OpenMark, SectionFloor } from "./SectionFloor";
import { Bar } from "./SectionGround";
import { SectionView } from "./SectionView";

const TURN_RAD = 0.1; // by one press of a key
const ZOOM = 1.2;

/** The floors above each other in three dimensions, to be turned; over them the marks of the side section.
 * Read aloud it is a list of floors. */
export function StackedFloors({ picture }: { picture: Picture }) {
  const paper = useRef<HTMLCanvasElement>(null);
  const stack = useRef<StackView | null>(null);
  const notice = useSignal(t("stack.loading")); // instead of the drawing
  const window = useSignal<Window>({ widthPx: 0, heightPx: 0 });
  const drawn = useSignal<DrawnStack | null>(null);
  const open = useSignal<string | null>(null); // the mark whose people are listed
  useEffect(() => {
    const element = paper.current;
    if (element === null) return undefined;
    let isClosed = false;
    const begin = async () => {
      if (!hasWebGl()) return t("stack.no_webgl");
      const { openStack } = await import("../stack/follow");
      if (!isClosed) stack.current = openStack(element, picture, window, drawn);
      return "";
    };
    void begin()
      .catch((error: unknown) => t("stack.not_loaded", { reason: String(error) }))
      .then((text) => (notice.value = text));
    return () => {
      isClosed = true;
      stack.current?.close();
      stack.current = null;
    };
  }, [picture]);
  useEffect(() => {
    const element = paper.current;
    if (element === null) return undefined;
    const observer = new ResizeObserver(() => {
      window.value = { widthPx: element.clientWidth, heightPx: element.clientHeight };
    });
    observer.observe(element);
    return () => observer.disconnect();
  }, []);
  const { widthPx, heightPx } = window.value;
  const marks = drawn.value?.floors.flatMap((one) => one.marks) ?? [];
  return (
    <section class="section" aria-label={t("stack.title")}>
      <div class="section-view stack-view">
        <canvas
          ref={paper}
          tabIndex={0}
          role="application"
          aria-label={t("stack.drawing")}
          aria-description={t("stack.keys")}
          onKeyDown={(event) => stack.current !== null && pressed(event, stack.current)}
        />
        <svg class="section-ground" width={widthPx} height={heightPx} aria-hidden="true" focusable="false">
          {marks.map((mark) => (
            <Bar key={mark.key} mark={mark} markPx={drawn.value?.markPx ?? 0} />
          ))}
        </svg>
        <ul aria-label={t("section.floors")}>
          {drawn.value?.floors.map((one) => (
            <SectionFloor
              key={one.floor}
              floor={one}
              label={{ top: `${one.yPx}px`, left: `${one.xPx}px` }}
              narrow
              open={open}
            />
          ))}
        </ul>
        {notice.value !== "" && <p role="status">{notice.value}</p>}
      </div>
      <div class="section-ends">
        <button type="button" onClick={() => stack.current?.fit()}>
          {t("plan_view.fit")}
        </button>
        <div class="section-choices">
          <Choice
            label={t("stack.spread")}
            choices={SPREADS}
            chosen={spread}
            textOf={(factor) => t("stack.spread_by", { factor })}
          />
          <SectionView />
        </div>
        <p class="quiet">{t("stack.legend")}</p>
      </div>
      <OpenMark floors={drawn.value?.floors ?? []} open={open} />
      <NotLocated picture={picture} />
    </section>
  );
}

function hasWebGl(): boolean {
  return document.createElement("canvas").getContext("webgl2") !== null;
}

function pressed(event: KeyboardEvent, stack: StackView): void {
  const actions: Record<string, () => void> = {
    ArrowLeft: () => stack.turn(TURN_RAD, 0),
    ArrowRight: () => stack.turn(-TURN_RAD, 0),
    ArrowUp: () => stack.turn(0, TURN_RAD),
    ArrowDown: () => stack.turn(0, -TURN_RAD),
    "+": () => stack.zoom(ZOOM),
    "-": () => stack.zoom(1 / ZOOM),
    "0": () => stack.fit(),
  };
  const action = actions[event.key];
  if (action === undefined) return;
  event.preventDefault();
  action();
}
