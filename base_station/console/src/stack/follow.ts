/** Updates the stacked floors to the picture, a few times a second at most, and only where they change. */
import { computed, effect, signal, type ReadonlySignal, type Signal } from "@preact/signals";
import { measureTextWidth } from "ol/render/canvas";
import { gloves, shownTheme } from "../appearance";
import { floorNames, units } from "../language/measures";
import { t } from "../language/translate";
import { guarded } from "../live/faults";
import type { Picture } from "../live/picture";
import { drawnRoute, rescue } from "../live/rescue";
import { readColours } from "../plan/colours";
import { shownKinds } from "../plan/pastTrails";
import { atMostEvery } from "../plan/redrawing";
import { markSizePx, NAME_FONT, SECTION_REDRAW_MS, type Window } from "../section/follow";
import { levelsOf, type Level } from "../section/levels";
import type { Scene } from "../section/members";
import { spread } from "../section/shown";
import { floor, selectedUnit } from "../uiState";
import type { TrailPoint } from "../wire";
import { stackedBuilding } from "./building";
import { StackCanvas, type StackLook } from "./canvas";
import { drawnStack, type DrawnStack } from "./drawing";
import { stackedRoute, stackedTrails } from "./paths";

const NO_TRAILS = new Map<string, readonly TrailPoint[]>();

export interface StackView {
  turn(leftRad: number, upRad: number): void;
  zoom(factor: number): void; // above 1 it becomes larger
  fit(): void;
  close(): void;
}

/** Draws the picture on a canvas, and updates it.  Raises an error where the browser has no WebGL. */
export function openStack(
  element: HTMLCanvasElement,
  picture: Picture,
  window: ReadonlySignal<Window>,
  drawn: Signal<DrawnStack | null>,
): StackView {
  const [turned, fitted] = [signal(0), signal(0)];
  const canvas = new StackCanvas(element, () => (turned.value = turned.peek() + 1));
  const levels = signal<readonly Level[]>([]);
  const siteId = computed(() => picture.incident.value?.site_id ?? "");
  const building = computed(() => {
    void fitted.value; // without a plan it is as large as the people are apart
    return stackedBuilding(picture.plan.value, levels.value, peopleOf(picture));
  });
  const look = computed<StackLook>(() => {
    void shownTheme.value;
    return { colours: readColours(), shown: floor.value, spread: Number(spread.value) };
  });
  const learnLevels = (before: readonly Level[]) => {
    const positions = picture.allUnits().flatMap(({ position }) => (position ? [position] : []));
    const next = levelsOf(picture.plan.peek(), positions, before);
    if (JSON.stringify(next) !== JSON.stringify(levels.peek())) levels.value = next;
  };
  const draw = () =>
    guarded(t("stack.title"), () => {
      const { widthPx, heightPx } = window.peek();
      if (widthPx === 0 || heightPx === 0) return; // not on the screen
      learnLevels(levels.peek());
      const scene = sceneOf(picture);
      const way = rescue.peek();
      const route = way === null ? null : drawnRoute(way);
      const trails = shownKinds.peek().has("fused") ? picture.trails.peek() : NO_TRAILS;
      canvas.showPaths(
        stackedTrails(scene, trails, levels.peek()),
        route === null ? null : stackedRoute(route, levels.peek()),
        look.peek(),
      );
      canvas.render();
      const next = drawnStack({
        scene,
        building: building.peek(),
        widthPx,
        heightPx,
        markPx: markSizePx(),
        pixelOf: (place) => canvas.pixelOf(place),
        textWidthPx: (text) => measureTextWidth(NAME_FONT, text),
      });
      if (JSON.stringify(next) !== JSON.stringify(drawn.peek())) drawn.value = next;
    });
  const redraw = atMostEvery(() => SECTION_REDRAW_MS, draw);
  const ends = [
    effect(() => {
      void siteId.value;
      learnLevels([]); // floors that were learnt are of another ground
    }),
    effect(() => {
      guarded(t("stack.title"), () => canvas.showBuilding(building.value, look.value));
    }),
    effect(() => {
      void [siteId.value, picture.plan.value, fitted.value, spread.value];
      const { widthPx, heightPx } = window.value;
      if (widthPx === 0 || heightPx === 0) return; // not on the screen
      canvas.resize(widthPx, heightPx);
      canvas.fit(building.peek());
    }),
    effect(() => {
      void [picture.unitsChanged.value, picture.alarms.value, picture.nowMs.value, rescue.value, shownKinds.value];
      redraw.ask();
    }),
    effect(() => {
      // What a person does is seen at once.
      void [selectedUnit.value, turned.value, window.value, building.value, look.value];
      void [gloves.value, floorNames.value, units.value];
      void t("stack.title"); // another language
      draw();
    }),
  ];
  return {
    turn: (leftRad, upRad) => canvas.turn(leftRad, upRad),
    zoom: (factor) => canvas.zoom(factor),
    fit: () => (fitted.value = fitted.peek() + 1),
    close() {
      ends.forEach((end) => end());
      redraw.cancel();
      canvas.close();
    },
  };
}

function sceneOf(picture: Picture): Scene {
  return {
    units: picture.allUnits(),
    alarms: picture.alarms.peek(),
    nowMs: picture.nowMs.peek(),
    chosen: selectedUnit.peek(),
  };
}

function peopleOf(picture: Picture): number[][] {
  return picture
    .allUnits()
    .flatMap(({ position }) => (position === null ? [] : [[position.east_m, position.north_m]]));
}
