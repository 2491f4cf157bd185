/** The plan as a map in site metres: paper, building, people; nothing else, and no WebGL. */
import Feature from "ol/Feature";
import OlMap from "ol/Map";
import View from "ol/View";
import ScaleLine from "ol/control/ScaleLine";
import { buffer, containsExtent, createEmpty, extend } from "ol/extent";
import Point from "ol/geom/Point";
import { defaults } from "ol/interaction/defaults";
import Translate from "ol/interaction/Translate";
import type { Route } from "../api";
import type { Units } from "../language/measures";
import { isSlow } from "../live/frameCost";
import type { FloorChoice } from "../uiState";
import type { Plan } from "../wire";
import { BaseMapLayer } from "./baseMap";
import { Building } from "./building";
import { readColours, type Colours } from "./colours";
import { edgeMarks, type EdgeMark, type Outside } from "./edges";
import { ExternalLayer, type ExternalScene } from "./externalLayer";
import { FloorPictureLayer } from "./floorPicture";
import { PeopleLayer } from "./peopleLayer";
import type { Scene } from "./peopleScene";
import { Grid } from "./grid";
import { ImportLayer, type ImportScene } from "./importLayer";
import { fitMargins, isInMiddle, leastMargins } from "./margins";
import type { Box, Pixel } from "./names";
import { PastLayer, type PastScene } from "./pastLayer";
import { RouteLayer } from "./routeLayer";
import { PIN_HALF_PX, PIN_HEIGHT_PX, PinLayer, type PinScene, type Standing } from "./pins";
import { SITE } from "./site";
import type { Place } from "./tools";

const TAP_PX = 29; // 15 mm across, as for hands in gloves
const CLOSE_M_PER_PX = 0.06;
const MOVING_KEYS = /^(Arrow.*|[+-])$/;
const MOVE_MS = 250;
const AROUND_M = 2;
/** Smallest extent of a fit, so that one person does not fill the screen with a few metres. */
const FITTED_M_PER_PX = 0.02;

/** Interactions with the plan. */
export interface PlanEvents {
  select(unitId: string): void;
  /** A click at any place; true if a tool has used it. */
  click(place: Place): boolean;
  choose(standing: Standing): void;
  moved(standing: Standing, place: Place): void;
  /** Members to whom arrows at the plan's edge point. */
  outside(marks: readonly EdgeMark[]): void;
}

export class PlanMap {
  private colours: Colours = readColours();
  private readonly grid = new Grid(this.colours);
  readonly ground = new BaseMapLayer();
  private readonly floorPicture = new FloorPictureLayer();
  private readonly building = new Building(this.colours);
  private readonly peopleLayer = new PeopleLayer();
  private readonly pins = new PinLayer();
  private readonly past = new PastLayer();
  private readonly external = new ExternalLayer();
  private readonly imported = new ImportLayer();
  private readonly route = new RouteLayer();
  private readonly scale = new ScaleLine({ minWidth: 80 });
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
  /** Whether the user has moved the view; until then all members are kept in view. */
  private chosen = false;
  private fitted = false;
  private people: Omit<Scene, "colours" | "screen"> | null = null; // as last shown

  constructor(
    target: HTMLElement,
    private readonly events: PlanEvents,
  ) {
    this.map = new OlMap({
      target,
      view: this.view,
      layers: [
        this.grid,
        this.ground,
        this.floorPicture,
        this.building.layer,
        this.past.layer,
        this.route.layer,
        this.external.layer,
        this.imported.layer,
        this.pins.labelLayer,
        this.peopleLayer.obstacles.layer,
        this.peopleLayer,
        this.pins.layer,
      ],
      interactions: defaults().extend([this.dragging()]),
      controls: [this.scale],
    });
    for (const kind of ["wheel", "pointerdown"]) {
      target.addEventListener(kind, () => (this.chosen = true), { passive: true });
    }
    target.addEventListener("keydown", ({ key }) => {
      if (MOVING_KEYS.test(key)) this.chosen = true;
    });
    this.map.on("moveend", () => this.drawPeople()); // names keep to what is on the screen
    this.map.on("change:size", () => {
      if (this.fitted && !this.chosen && this.isSeen()) this.fit(false);
    });
    this.map.on("singleclick", (event) => {
      if (this.events.click(placeOf(event.coordinate))) return;
      const standing = this.standingAt(event.pixel);
      if (standing !== null) this.events.choose(standing);
      else this.selectNear(event.coordinate, event.pixel);
    });
  }

  showPins(scene: Omit<PinScene, "colours">): void {
    this.pins.show({ ...scene, colours: this.colours });
    this.drawPeople(); // names of people and pins keep clear of pins
  }

  showPast(scene: PastScene): void {
    this.past.show(scene, this.colours);
  }

  showRoute(route: Route | null, floor: FloorChoice): void {
    this.route.show(route, floor, this.colours);
  }

  showImports(scene: ImportScene): void {
    this.imported.show(scene, this.colours);
  }

  showExternal(scene: ExternalScene): void {
    this.external.show(scene, this.colours);
  }

  private selectNear(coordinate: number[], clicked: number[]): void {
    const hit = this.peopleLayer.nearest(coordinate);
    if (hit === null) return;
    const pixel = this.map.getPixelFromCoordinate(hit.at);
    const apart = Math.hypot(
      (pixel[0] ?? 0) - (clicked[0] ?? 0),
      (pixel[1] ?? 0) - (clicked[1] ?? 0),
    );
    if (apart <= TAP_PX) this.events.select(hit.unitId);
  }

  private standingAt(pixel: number[]): Standing | null {
    const found = this.map.forEachFeatureAtPixel(
      pixel,
      (feature) => (feature instanceof Feature ? this.pins.standing(feature) : null) ?? undefined,
      { layerFilter: (layer) => layer === this.pins.layer, hitTolerance: TAP_PX / 2 },
    );
    return found ?? null;
  }

  /** The chosen pin or beacon can be dragged. */
  private dragging(): Translate {
    const translate = new Translate({
      layers: [this.pins.layer],
      filter: (feature) => feature instanceof Feature && this.pins.isDraggable(feature),
      hitTolerance: TAP_PX / 2,
    });
    translate.on("translateend", (event) => {
      for (const feature of event.features.getArray()) {
        const standing = this.pins.standing(feature);
        const at = feature.getGeometry();
        if (standing !== null && at instanceof Point) {
          this.events.moved(standing, placeOf(at.getCoordinates()));
        }
      }
    });
    return translate;
  }

  showUnits(units: Units): void {
    this.scale.setUnits(units);
  }

  showPlan(plan: Plan | null): void {
    this.building.show(plan);
    this.floorPicture.showPlan(plan);
    this.fitted = false;
  }

  showPeople(people: Omit<Scene, "colours" | "screen">): void {
    this.building.choose(people.floor, this.colours);
    this.floorPicture.choose(people.floor);
    this.people = people;
    this.drawPeople();
    if (!this.isSeen()) return;
    if (!this.fitted) this.fitted = this.fit(false);
    else if (!this.chosen && !this.showsEverybody()) this.fit();
  }

  private drawPeople(): void {
    if (this.people === null) return;
    const [right = 0, down = 0] = this.map.getSize() ?? [];
    const pixelOf = (at: number[]) => this.pixelOf(at);
    const [covered, standing] = [this.covered(), this.standing()];
    const screen = { size: [right, down], covered, standing, pixelOf } as const;
    const taken = this.peopleLayer.show({ ...this.people, colours: this.colours, screen });
    this.pins.name({ ...screen, standing: [...standing, ...taken] }, this.colours);
    this.events.outside(edgeMarks(this.endangered(), [right, down], covered));
  }

  private endangered(): Outside[] {
    return this.peopleLayer.endangered.flatMap(({ centre, ...one }) => {
      const mark = this.pixelOf(centre);
      return mark === null ? [] : [{ ...one, mark }];
    });
  }

  /** What lies over the plan. */
  private covered(): Box[] {
    const map = this.map.getTargetElement();
    if (!map) return []; // it is being closed
    const { left: x, top: y } = map.getBoundingClientRect();
    const over = map.parentElement?.querySelectorAll(".zoom, .north, .ol-scale-line") ?? [];
    return [...over].map((one): Box => {
      const { left, top, right, bottom } = one.getBoundingClientRect();
      return [left - x, top - y, right - x, bottom - y];
    });
  }

  /** Pins and beacons. */
  private standing(): Box[] {
    return this.pins.places().flatMap((at): Box[] => {
      const [right, down] = this.pixelOf(at) ?? [];
      if (right === undefined || down === undefined) return [];
      return [[right - PIN_HALF_PX, down - PIN_HEIGHT_PX, right + PIN_HALF_PX, down + PIN_HALF_PX]];
    });
  }

  /** Null before the first drawing. */
  private pixelOf(at: number[]): Pixel | null {
    return this.map.getPixelFromCoordinate(at) as [number, number] | null;
  }

  /** False while another part of a small screen is shown. */
  private isSeen(): boolean {
    return this.map.getSize()?.every((pixels) => pixels > 0) ?? false;
  }

  private showsEverybody(): boolean {
    const extent = this.peopleLayer.extent();
    if (extent === null || !extent.every(Number.isFinite)) return true;
    const size = this.map.getSize();
    const mPerPx = this.view.getResolution() ?? 0;
    const [top, right, bottom, left] = leastMargins(size ?? []);
    const [west = 0, south = 0, east = 0, north = 0] = extent;
    const needed = [
      west - left * mPerPx,
      south - bottom * mPerPx,
      east + right * mPerPx,
      north + top * mPerPx,
    ];
    return containsExtent(this.view.calculateExtent(size), needed);
  }

  /** Shows all contents; false if there are none yet. */
  fit(smoothly = true): boolean {
    const all = createEmpty();
    for (const part of [this.building.extent(), this.floorPicture.extent(), this.peopleLayer.extent()]) {
      if (part !== null) extend(all, part);
    }
    if (!all.every(Number.isFinite)) return false;
    this.chosen = false;
    this.view.fit(buffer(all, AROUND_M), {
      padding: [...fitMargins(this.map.getSize() ?? [])],
      minResolution: FITTED_M_PER_PX,
      ...(smoothly ? moving() : {}),
    });
    return true;
  }

  /** Show a place from near.  The plan moves only where that is not so yet, and then at once: with many people
   * each step of a glide would be a drawing of all. */
  showNear(at: [number, number]): void {
    this.chosen = true;
    const resolution = this.view.getResolution() ?? Infinity;
    if (resolution <= CLOSE_M_PER_PX && isInMiddle(this.pixelOf(at), this.map.getSize() ?? [])) return;
    this.view.setCenter(at);
    this.view.setResolution(Math.min(resolution, CLOSE_M_PER_PX));
  }

  zoom(steps: number): void {
    this.chosen = true;
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

function placeOf([east_m = 0, north_m = 0]: number[]): Place {
  return { north_m, east_m };
}

function moving(): { duration: number } {
  const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
  return { duration: still || isSlow() ? 0 : MOVE_MS };
}
