/** People on the plan: layers whose features follow the picture. */
import type { Extent } from "ol/extent";
import Feature from "ol/Feature";
import MultiLineString from "ol/geom/MultiLineString";
import Point from "ol/geom/Point";
import VectorLayer from "ol/layer/Vector";
import { measureTextWidth } from "ol/render/canvas";
import VectorSource from "ol/source/Vector";
import { guarded } from "../live/faults";
import { displayName, urgencyOf } from "../live/urgency";
import type { FloorChoice } from "../uiState";
import type { AlarmView, PositionView, TrailPoint, UnitView } from "../wire";
import { initials } from "../format";
import { t } from "../language/translate";
import type { Colours } from "./colours";
import { isOld, outline } from "./ellipse";
import { floorBadge, floorRemark, floorsUp } from "./floors";
import {
  isStrong,
  labelFont,
  labelOf,
  labelStyle,
  markStyle,
  trailStyle,
  type Mark,
} from "./marks";
import {
  BESIDE,
  boxesOf,
  placeNames,
  type Box,
  type Named,
  type Place,
  type Screen,
  type Side,
} from "./names";
import { RegionLayer } from "./regionLayer";
import { siteCoordinate } from "./site";
import { spanMs, trailLines } from "./trail";

export interface Scene {
  units: readonly UnitView[];
  alarms: ReadonlyMap<string, AlarmView>;
  trails: ReadonlyMap<string, readonly TrailPoint[]>;
  nowMs: number;
  silentMs: number;
  floor: FloorChoice;
  chosen: string | null;
  colours: Colours;
  screen: Screen;
}

const HEADING_KNOWN_RAD = 0.8;
const LABEL_LIMIT = 12;

/** Somebody who is to be drawn. */
interface Shown {
  unit: UnitView;
  looks: Mark;
  centre: [number, number];
  border: [number, number][];
  figure: Figure;
}

/** The features of one person, and on which side the name stands. */
interface Figure {
  named: Side | null;
  trail: Feature<MultiLineString>;
  mark: Feature<Point>;
  label: Feature<Point>;
}

/** A member in danger, as drawn. */
export interface Endangered {
  unitId: string;
  name: string;
  initials: string;
  centre: [number, number];
}

export class PeopleLayer {
  /** As last shown. */
  endangered: readonly Endangered[] = [];
  private readonly figures = new Map<string, Figure>();
  private readonly trails = new VectorSource<Feature<MultiLineString>>();
  private readonly regions = new RegionLayer();
  private readonly marks = new VectorSource<Feature<Point>>();
  private readonly labels = new VectorSource<Feature<Point>>();
  readonly layers = [
    this.regions.layer,
    new VectorLayer({ source: this.trails }),
    new VectorLayer({ source: this.marks }),
    new VectorLayer({ source: this.labels, declutter: true }),
  ];

  /** Answers what people and their names cover of the screen. */
  show(scene: Scene): Box[] {
    const shown = new Map<string, Shown>();
    for (const unit of scene.units) {
      guarded(t("plan.unit", { unit: unit.unit_id }), () => {
        const { position } = unit;
        if (position === null || !isShown(unit, position, scene)) return;
        const looks = markOf(unit, position, scene);
        const centre = siteCoordinate(position);
        const border = isMissed(unit, looks) ? outline(centre, position, scene.silentMs) : [];
        shown.set(unit.unit_id, { unit, looks, centre, border, figure: this.figure(unit.unit_id) });
      });
    }
    for (const unitId of this.figures.keys()) {
      if (!shown.has(unitId)) this.forget(unitId);
    }
    const all = [...shown.values()];
    this.endangered = all
      .filter(({ looks }) => looks.urgency === "immediate")
      .map(({ unit, looks, centre }) => ({
        unitId: unit.unit_id,
        name: looks.name,
        initials: looks.initials,
        centre,
      }));
    const named = namedOf(all, scene.screen);
    const places = placeNames(named, scene.screen);
    this.regions.show(all, scene.colours);
    all.forEach((one, i) =>
      guarded(t("plan.unit", { unit: one.unit.unit_id }), () => draw(one, places[i] ?? null, scene)),
    );
    return named.flatMap((one, i) => boxesOf(one, places[i] ?? null));
  }

  /** Where people are, without the regions about them. */
  extent(): Extent | null {
    return this.marks.getExtent() ?? null;
  }

  /** The unit whose mark is nearest to a coordinate, and where it is. */
  nearest(coordinate: number[]): { unitId: string; at: number[] } | null {
    const feature = this.marks.getClosestFeatureToCoordinate(coordinate);
    const at = feature?.getGeometry()?.getCoordinates();
    return feature && at ? { unitId: String(feature.getId()), at } : null;
  }

  private figure(unitId: string): Figure {
    const known = this.figures.get(unitId);
    if (known !== undefined) return known;
    const figure = {
      named: null,
      trail: new Feature(new MultiLineString([])),
      mark: new Feature(new Point([0, 0])),
      label: new Feature(new Point([0, 0])),
    };
    for (const feature of [figure.trail, figure.mark, figure.label]) feature.setId(unitId);
    this.trails.addFeature(figure.trail);
    this.marks.addFeature(figure.mark);
    this.labels.addFeature(figure.label);
    this.figures.set(unitId, figure);
    return figure;
  }

  private forget(unitId: string): void {
    const figure = this.figures.get(unitId);
    if (figure === undefined) return;
    this.figures.delete(unitId);
    this.trails.removeFeature(figure.trail);
    this.marks.removeFeature(figure.mark);
    this.labels.removeFeature(figure.label);
  }
}

function namedOf(all: readonly Shown[], screen: Screen): Named[] {
  return all.map(({ centre, looks, figure }) => ({
    mark: screen.pixelOf(centre) ?? BESIDE,
    widthPx: measureTextWidth(labelFont(looks), labelOf(looks)),
    strong: isStrong(looks),
    before: figure.named,
  }));
}

function draw({ unit, looks, centre, figure }: Shown, name: Place | null, scene: Scene): void {
  const { trail, mark, label } = figure;
  const { colours } = scene;
  const walked = hasTrail(looks, scene) ? (scene.trails.get(unit.unit_id) ?? []) : [];
  const drawnMs = spanMs(looks.chosen, looks.urgency);
  trail.getGeometry()?.setCoordinates(trailLines(walked, scene.nowMs, scene.floor, drawnMs));
  mark.getGeometry()?.setCoordinates(centre);
  label.getGeometry()?.setCoordinates(centre);
  trail.setStyle(trailStyle(looks, colours));
  mark.setStyle(markStyle(looks, colours));
  figure.named = name?.side ?? null;
  label.setStyle(name === null ? [] : labelStyle(looks, colours, name.offset));
}

/** On the chosen floor or on a floor that nobody knows; and wherever they are, who is chosen and who
 * is in danger. */
function isShown(unit: UnitView, position: PositionView, scene: Scene): boolean {
  const danger = urgencyOf(unit, scene.alarms) === "immediate";
  return isHere(position, scene) || danger || unit.unit_id === scene.chosen;
}

function isHere({ floor }: PositionView, scene: Scene): boolean {
  return scene.floor === "all" || floor === null || floor === scene.floor;
}

/** Where somebody can have got to since is asked of who is looked for, and grows over the whole plan:
 * not of a unit that was switched off in order while its wearer was well. */
function isMissed(unit: UnitView, { urgency }: Mark): boolean {
  return unit.link === "live" || !unit.switched_off || urgency === "immediate";
}

/** In a crowd trails would hide the plan: those of whom somebody looks for remain. */
function hasTrail({ chosen, urgency }: Mark, { units }: Scene): boolean {
  return units.length <= LABEL_LIMIT || chosen || urgency === "immediate";
}

function markOf(unit: UnitView, position: PositionView, scene: Scene): Mark {
  const name = displayName(unit);
  const old = isOld(position, scene.nowMs) || position.reach.length > 0;
  return {
    name,
    initials: initials(name),
    urgency: urgencyOf(unit, scene.alarms),
    chosen: unit.unit_id === scene.chosen,
    old,
    ageMs: scene.nowMs - position.t_ms,
    floor: floorRemark(position, scene.floor, old),
    floorsUp: floorsUp(position, scene.floor),
    floorBadge: floorBadge(position, scene.floor),
    headingRad: position.heading_rad,
    headingKnown: position.heading_std_rad < HEADING_KNOWN_RAD,
  };
}
