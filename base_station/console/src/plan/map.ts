/** The plan as a map in site metres: paper, building, people; nothing else, and no WebGL. */
import OlMap from "ol/Map";
import View from "ol/View";
import ScaleLine from "ol/control/ScaleLine";
import { buffer, createEmpty, extend } from "ol/extent";
import type { Plan } from "../wire";
import { Building } from "./building";
import { readColours, type Colours } from "./colours";
import { Crowd, type Scene } from "./crowd";
import { Grid } from "./grid";
import { SITE } from "./site";

const TAP_PX = 26;
const CLOSE_M_PER_PX = 0.06;
const MARGIN_PX = 40;
const RIGHT_MARGIN_PX = 70; // the zoom buttons
const MOVE_MS = 250;
const AROUND_M = 2;

export class PlanMap {
  private colours: Colours = readColours();
  private readonly grid = new Grid(this.colours);
  private readonly building = new Building(this.colours);
  private readonly crowd = new Crowd();
  private readonly view = new View({
    projection: SITE,
    center: [0, 0],
    resolution: 0.1,
    minResolution: 0.01,
    maxResolution: 10,
    enableRotation: false,
    showFullExtent: true,
  });
  private readonly map: OlMap;
  private fitted = false;

  constructor(target: HTMLElement, onSelect: (unitId: string) => void) {
    this.map = new OlMap({
      target,
      view: this.view,
      layers: [this.grid, this.building.layer, ...this.crowd.layers],
      controls: [new ScaleLine({ minWidth: 80 })],
    });
    this.map.on("singleclick", (event) => {
      const hit = this.crowd.nearest(event.coordinate);
      if (hit === null) return;
      const pixel = this.map.getPixelFromCoordinate(hit.at);
      const apart = Math.hypot(
        (pixel[0] ?? 0) - (event.pixel[0] ?? 0),
        (pixel[1] ?? 0) - (event.pixel[1] ?? 0),
      );
      if (apart <= TAP_PX) onSelect(hit.unitId);
    });
  }

  showPlan(plan: Plan | null): void {
    this.building.show(plan);
    this.fitted = false;
  }

  showPeople(scene: Omit<Scene, "colours">): void {
    this.building.choose(scene.floor, this.colours);
    this.crowd.show({ ...scene, colours: this.colours });
    if (!this.fitted) this.fitted = this.fit(false);
  }

  /** Show everything there is; false where there is nothing yet. */
  fit(smoothly = true): boolean {
    const all = createEmpty();
    for (const part of [this.building.extent(), this.crowd.extent()]) {
      if (part !== null) extend(all, part);
    }
    if (!all.every(Number.isFinite)) return false;
    this.view.fit(buffer(all, AROUND_M), {
      padding: [MARGIN_PX, RIGHT_MARGIN_PX, MARGIN_PX, MARGIN_PX],
      ...(smoothly ? moving() : {}),
    });
    return true;
  }

  centre(at: [number, number]): void {
    const resolution = Math.min(this.view.getResolution() ?? CLOSE_M_PER_PX, CLOSE_M_PER_PX);
    this.view.animate({ center: at, resolution, ...moving() });
  }

  zoom(steps: number): void {
    this.view.adjustZoom(steps);
  }

  recolour(): void {
    this.colours = readColours();
    this.grid.recolour(this.colours);
  }

  close(): void {
    this.map.setTarget(undefined);
    this.map.dispose();
  }
}

function moving(): { duration: number } {
  const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
  return { duration: still ? 0 : MOVE_MS };
}
