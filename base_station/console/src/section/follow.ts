/** Updates the side section to the picture, a few times a second at most, and only where it changes. */
import { effect, type Signal } from "@preact/signals";
import { measureTextWidth } from "ol/render/canvas";
import { gloves } from "../appearance";
import { floorNames, units } from "../language/measures";
import { t } from "../language/translate";
import { guarded } from "../live/faults";
import type { Picture } from "../live/picture";
import { atMostEvery } from "../plan/redrawing";
import { selectedUnit } from "../uiState";
import { drawnSection, type DrawnSection } from "./drawing";
import { levelsOf, type Level } from "./levels";
import { axis } from "./shown";

export const NAME_FONT = "600 14px system-ui, sans-serif";
/** Half as often as the plan, beside which it may stand. */
export const SECTION_REDRAW_MS = 400;
const MARK_PX = 30;
const GLOVED_MARK_PX = 57; // 15 mm
/** Less wide than this, floors have their short names. */
export const NARROW_PX = 520;
const GUTTER_PX = { narrow: 44, wide: 136 };

export function markSizePx(): number {
  return gloves.peek() === "on" ? GLOVED_MARK_PX : MARK_PX;
}

export interface Window {
  widthPx: number;
  heightPx: number;
}

/** Starts the updates; the returned function ends them. */
export function followSection(
  picture: Picture,
  window: Signal<Window>,
  drawn: Signal<DrawnSection | null>,
): () => void {
  let levels: readonly Level[] = [];
  let ground: unknown = null; // on which the levels were learnt
  const draw = () =>
    guarded(t("section.title"), () => {
      const { widthPx, heightPx } = window.peek();
      if (widthPx === 0 || heightPx === 0) return; // not on the screen
      const units = picture.allUnits();
      const positions = units.flatMap(({ position }) => (position ? [position] : []));
      const site = picture.incident.peek()?.site_id ?? "";
      levels = levelsOf(picture.plan.peek(), positions, site === ground ? levels : []);
      ground = site;
      const next = drawnSection({
        scene: {
          units,
          alarms: picture.alarms.peek(),
          nowMs: picture.nowMs.peek(),
          chosen: selectedUnit.peek(),
        },
        plan: picture.plan.peek(),
        levels,
        axis: axis.peek(),
        size: {
          widthPx,
          heightPx,
          markPx: markSizePx(),
          gutterPx: widthPx < NARROW_PX ? GUTTER_PX.narrow : GUTTER_PX.wide,
        },
        textWidthPx: (text) => measureTextWidth(NAME_FONT, text),
      });
      if (JSON.stringify(next) !== JSON.stringify(drawn.peek())) drawn.value = next;
    });
  const redraw = atMostEvery(() => SECTION_REDRAW_MS, draw);
  const ends = [
    effect(() => {
      void [picture.unitsChanged.value, picture.alarms.value, picture.plan.value, picture.nowMs.value];
      redraw.ask();
    }),
    effect(() => {
      // What a person does is seen at once.
      void [selectedUnit.value, axis.value, window.value, gloves.value, floorNames.value, units.value];
      void t("section.title"); // another language
      draw();
    }),
  ];
  return () => {
    ends.forEach((end) => end());
    redraw.cancel();
  };
}
