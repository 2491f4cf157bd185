/** Pins and beacons on the plan, each with the region in which it may be wrong. */
import Feature from "ol/Feature";
import Circle from "ol/geom/Circle";
import Point from "ol/geom/Point";
import VectorLayer from "ol/layer/Vector";
import VectorSource from "ol/source/Vector";
import { Fill, Stroke, Style, Text } from "ol/style";
import type { State as RenderState } from "ol/render";
import { measureTextWidth } from "ol/render/canvas";
import type { FloorChoice } from "../uiState";
import type { BeaconView, PinView } from "../wire";
import { planLabel } from "../format";
import { clock } from "../language/measures";
import { t } from "../language/translate";
import { faint, type Colours } from "./colours";
import { BESIDE, placeNames, type Named, type Pixel, type Screen, type Side } from "./names";
import { siteCoordinate } from "./site";
import type { Place } from "./tools";

export interface PinScene {
  pins: readonly PinView[];
  beacons: readonly BeaconView[];
  names: ReadonlyMap<string, string>; // of who wears which unit
  floor: FloorChoice;
  chosen: string | null; // id of a pin or beacon
  clicked: readonly Place[];
  colours: Colours;
}

/** A movable object on the plan. */
export interface Standing {
  kind: "pin" | "beacon";
  id: string;
}

/** A pin with the name of its member. */
interface Labelled {
  pinId: string;
  text: string;
  chosen: boolean;
  at: [number, number];
}

const LABEL_FONT = "600 13px system-ui, sans-serif";
const RADIUS_95 = 2.447; // standard deviations that hold 95 % in a plane
const STEM_PX = 20;
const HEAD_PX = 7;
/** Size of a pin above and beside its place; a beacon is no larger. */
export const PIN_HEIGHT_PX = STEM_PX + HEAD_PX + 2;
export const PIN_HALF_PX = HEAD_PX + 2;

export class PinLayer {
  private readonly source = new VectorSource<Feature>();
  private readonly labels = new VectorSource<Feature>();
  private chosen: string | null = null;
  private labelled: Labelled[] = [];
  private sides = new Map<string, Side>(); // on which each label stands
  private placed = ""; // the labels as drawn
  readonly layer = new VectorLayer({ source: this.source });
  /** Below those of people. */
  readonly labelLayer = new VectorLayer({ source: this.labels, declutter: true });

  show(scene: PinScene): void {
    this.source.clear(true);
    this.labelled = [];
    this.chosen = scene.chosen;
    for (const beacon of scene.beacons) {
      if (isOn(beacon.floor, scene.floor)) this.addBeacon(beacon, scene);
    }
    for (const pin of scene.pins) {
      if (pin.north_m === null || pin.east_m === null || !isOn(pin.floor, scene.floor)) continue;
      if (pin.kind === "beacon" || pin.kind === "tag") continue; // the beacon itself is drawn
      this.addPin(pin, { north_m: pin.north_m, east_m: pin.east_m }, scene);
    }
    scene.clicked.forEach((place, i) => this.addClick(place, i, scene));
  }

  /** Labels the pins on the visible part of the plan where no mark or name is; a chosen pin is always
   * labelled. */
  name(screen: Screen, colours: Colours): void {
    const named = this.labelled.map(({ pinId, text, chosen, at }): Named => {
      const [right, down] = screen.pixelOf(at) ?? BESIDE;
      return {
        mark: [right, down - STEM_PX],
        widthPx: measureTextWidth(LABEL_FONT, text),
        strong: chosen,
        first: chosen,
        before: this.sides.get(pinId) ?? "above",
      };
    });
    const places = placeNames(named, screen);
    const placed = JSON.stringify([this.labelled, places, colours]);
    if (placed === this.placed) return; // to draw it anew draws the whole map anew
    this.placed = placed;
    this.labels.clear(true);
    this.sides = new Map();
    this.labelled.forEach(({ pinId, text, at }, i) => {
      const place = places[i] ?? null;
      if (place === null) return;
      this.sides.set(pinId, place.side);
      const [right, down] = place.offset;
      const label = new Feature({ geometry: new Point(at) });
      label.setStyle(textStyle(text, [right, down - STEM_PX], colours, "obstacle"));
      this.labels.addFeature(label);
    });
  }

  /** Whether a feature of the map is one that can be chosen. */
  standing(feature: Feature): Standing | null {
    return (feature.get("standing") as Standing | undefined) ?? null;
  }

  /** Positions of pins and beacons. */
  places(): number[][] {
    const standing = this.source.getFeatures().filter((one) => this.standing(one) !== null);
    return standing.map((one) => (one.getGeometry() as Point).getCoordinates());
  }

  /** Only a chosen object can be dragged, so that panning the plan moves no pin. */
  isDraggable(feature: Feature): boolean {
    const standing = this.standing(feature);
    return standing !== null && standing.id === this.chosen;
  }

  private addPin(pin: PinView, at: Place, scene: PinScene): void {
    const chosen = scene.chosen === pin.pin_id;
    const colour = pinColour(pin, scene.colours);
    this.addRegion(at, RADIUS_95 * pin.std_m, colour, chosen);
    const mark = new Feature({ geometry: new Point(siteCoordinate(at)) });
    mark.set("standing", { kind: "pin", id: pin.pin_id } satisfies Standing);
    mark.setStyle(
      new Style({
        zIndex: chosen ? 3 : 1,
        renderer: (where, state) =>
          drawAt(where as number[], state, (context) => drawPin(context, pin.state, colour, scene.colours.halo)),
      }),
    );
    this.source.addFeature(mark);
    if (!chosen && !isNamed(pin)) return;
    const text = pinWords(pin, scene.names.get(pin.unit_id) ?? pin.unit_id);
    this.labelled.push({ pinId: pin.pin_id, text, chosen, at: siteCoordinate(at) });
  }

  private addBeacon(beacon: BeaconView, scene: PinScene): void {
    const chosen = scene.chosen === beacon.beacon_id;
    const colour = scene.colours.watch;
    if (chosen) this.addRegion(beacon, beacon.reach_m, colour, true);
    const mark = new Feature({ geometry: new Point(siteCoordinate(beacon)) });
    mark.set("standing", { kind: "beacon", id: beacon.beacon_id } satisfies Standing);
    mark.setStyle([
      new Style({
        zIndex: chosen ? 3 : 1,
        renderer: (where, state) => drawDiamond(where as number[], state, colour, scene.colours),
      }),
      textStyle(planLabel(beacon.label || beacon.beacon_id), [0, 17], scene.colours),
    ]);
    this.source.addFeature(mark);
  }

  /** Points clicked with a tool. */
  private addClick(place: Place, index: number, { colours }: PinScene): void {
    const mark = new Feature({ geometry: new Point(siteCoordinate(place)) });
    mark.setStyle([
      new Style({
        zIndex: 4,
        renderer: (where, state) => drawCross(where as number[], state, colours.chosen),
      }),
      textStyle(String(index + 1), [0, -18], colours),
    ]);
    this.source.addFeature(mark);
  }

  private addRegion(at: Place, radiusM: number, colour: string, chosen: boolean): void {
    const region = new Feature({ geometry: new Circle(siteCoordinate(at), radiusM) });
    region.setStyle(
      new Style({
        stroke: new Stroke({ color: faint(colour, 0.8), width: chosen ? 2 : 1, lineDash: [3, 4] }),
        fill: new Fill({ color: faint(colour, chosen ? 0.12 : 0.05) }),
      }),
    );
    this.source.addFeature(region);
  }
}

function isOn(floor: number | null, chosen: FloorChoice): boolean {
  return chosen === "all" || floor === null || floor === chosen;
}

function pinColour(pin: PinView, colours: Colours): string {
  if (pin.state === "conflict") return colours.immediate;
  return pin.state === "waiting" ? colours.quiet : colours.chosen;
}

/** Pins that need attention: conflicting ones, and pins of a unit that is not received, which have no
 * effect until positions come. */
export function isNamed({ state, t_ms }: PinView): boolean {
  return state === "conflict" || (state === "waiting" && t_ms > 0);
}

/** Marked as a pin, as it is no current position. */
export function pinWords(pin: PinView, name: string): string {
  const when = pin.t_ms === 0 ? t("mark.start") : clock(pin.t_ms, false);
  return t("mark.pin", { name: planLabel(name), when });
}

function textStyle(
  text: string,
  [offsetX, offsetY]: Pixel,
  colours: Colours,
  declutterMode: "obstacle" | "none" = "none",
): Style {
  return new Style({
    zIndex: 4,
    text: new Text({
      text,
      declutterMode,
      font: LABEL_FONT,
      offsetX,
      offsetY,
      fill: new Fill({ color: colours.text }),
      stroke: new Stroke({ color: colours.halo, width: 4 }),
    }),
  });
}

type Context = RenderState["context"];

function drawAt(where: number[], { context, pixelRatio }: RenderState, draw: (c: Context) => void) {
  context.save();
  context.translate(where[0] ?? 0, where[1] ?? 0);
  context.scale(pixelRatio, pixelRatio);
  draw(context);
  context.restore();
}

/** A pin with a head, its place at the origin: full while it is used, hollow while it waits, with "!" where
 * it conflicts. */
export function drawPin(context: Context, pinState: string, colour: string, halo: string): void {
  context.lineWidth = 2.5;
  context.strokeStyle = colour;
  context.beginPath();
  context.moveTo(0, 0);
  context.lineTo(0, -STEM_PX + HEAD_PX);
  context.stroke();
  context.beginPath();
  context.arc(0, -STEM_PX, HEAD_PX, 0, 2 * Math.PI);
  context.fillStyle = pinState === "waiting" ? halo : colour;
  context.fill();
  context.stroke();
  if (pinState !== "conflict") return;
  context.fillStyle = halo;
  context.font = "800 11px system-ui, sans-serif";
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillText("!", 0, -STEM_PX + 0.5);
}

function drawDiamond(where: number[], state: RenderState, colour: string, colours: Colours): void {
  drawAt(where, state, (context) => {
    context.rotate(Math.PI / 4);
    context.fillStyle = colour;
    context.strokeStyle = colours.halo;
    context.lineWidth = 2;
    context.fillRect(-6, -6, 12, 12);
    context.strokeRect(-6, -6, 12, 12);
  });
}

function drawCross(where: number[], state: RenderState, colour: string): void {
  drawAt(where, state, (context) => {
    context.strokeStyle = colour;
    context.lineWidth = 2.5;
    context.beginPath();
    context.moveTo(-10, 0);
    context.lineTo(10, 0);
    context.moveTo(0, -10);
    context.lineTo(0, 10);
    context.stroke();
  });
}
