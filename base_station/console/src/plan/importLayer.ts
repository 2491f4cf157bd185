/** Draws imported data: dashed trails with a square at their end, and photographs as pins with a small
 * picture, so that they are not taken for measurements of this station. */
import Feature from "ol/Feature";
import MultiLineString from "ol/geom/MultiLineString";
import Point from "ol/geom/Point";
import VectorLayer from "ol/layer/Vector";
import VectorSource from "ol/source/Vector";
import { Fill, Icon, RegularShape, Stroke, Style, Text } from "ol/style";
import type { ImportedTracks } from "../importedFiles";
import { t } from "../language/translate";
import type { FloorChoice } from "../uiState";
import type { TrailPoint } from "../wire";
import type { Colours } from "./colours";
import { emptied } from "./emptied";
import { countUntil, placeAt } from "./imports";
import { trailLines, TRAIL_MS } from "./trail";

/** External receivers may save one point a minute. */
const MOST_STEP_MS = 120_000;
const PICTURE_PX = 72;
const STEM_PX = 14;
const joined = (before: TrailPoint, point: TrailPoint) => point[0] - before[0] <= MOST_STEP_MS;

export interface ImportScene {
  imports: readonly ImportedTracks[];
  nowMs: number;
  floor: FloorChoice;
}

export class ImportLayer {
  private readonly source = new VectorSource<Feature>();
  readonly layer = new VectorLayer({ source: this.source, declutter: true });

  show({ imports, nowMs, floor }: ImportScene, colours: Colours): void {
    emptied(this.source);
    for (const { tracks, picture_url } of imports) {
      for (const { name, points } of tracks) {
        if (picture_url !== null) this.addPhoto(name, picture_url, points, nowMs, colours);
        else this.addTrack(name, points, { nowMs, floor }, colours);
      }
    }
  }

  private addTrack(
    name: string,
    points: readonly TrailPoint[],
    { nowMs, floor }: Omit<ImportScene, "imports">,
    colours: Colours,
  ): void {
    const recent = points.slice(countUntil(points, nowMs - TRAIL_MS), countUntil(points, nowMs));
    const lines = trailLines(recent, nowMs, floor, TRAIL_MS, joined);
    if (lines.length > 0) {
      const trail = new Feature(new MultiLineString(lines));
      trail.setStyle(new Style({ stroke: new Stroke({ color: colours.text, width: 2, lineDash: [8, 6] }) }));
      this.source.addFeature(trail);
    }
    const place = placeAt(recent, nowMs);
    if (place === null || !isOn(place, floor)) return;
    const mark = new Feature(new Point(coordinate(place)));
    mark.setStyle(
      new Style({
        image: new RegularShape({
          points: 4,
          angle: Math.PI / 4,
          radius: 9,
          declutterMode: "none", // a name may be hidden by another, a mark never
          fill: new Fill({ color: colours.halo }),
          stroke: new Stroke({ color: colours.text, width: 2, lineDash: [3, 2] }),
        }),
        text: nameOf(name, 20, colours),
      }),
    );
    this.source.addFeature(mark);
  }

  /** Shown from its time on. */
  private addPhoto(
    name: string,
    url: string,
    points: readonly TrailPoint[],
    nowMs: number,
    colours: Colours,
  ): void {
    const place = points[0];
    if (place === undefined || place[0] > nowMs) return;
    const pin = new Feature(new Point(coordinate(place)));
    pin.setStyle([
      new Style({
        image: new RegularShape({
          points: 3,
          angle: Math.PI,
          radius: STEM_PX,
          displacement: [0, STEM_PX / 2],
          declutterMode: "none",
          fill: new Fill({ color: colours.text }),
        }),
        text: nameOf(name, 12, colours),
      }),
      new Style({
        image: new Icon({
          src: url,
          width: PICTURE_PX,
          anchor: [0.5, 1],
          displacement: [0, STEM_PX],
          declutterMode: "none",
        }),
      }),
    ]);
    this.source.addFeature(pin);
  }
}

function nameOf(name: string, offsetY: number, colours: Colours): Text {
  return new Text({
    text: t("imports.on_plan", { name }),
    font: "italic 13px sans-serif",
    offsetY,
    fill: new Fill({ color: colours.text }),
    stroke: new Stroke({ color: colours.halo, width: 3 }),
  });
}

function coordinate([, north_m, east_m]: TrailPoint): [number, number] {
  return [east_m, north_m];
}

function isOn([, , , on]: TrailPoint, floor: FloorChoice): boolean {
  return floor === "all" || on === null || on === floor;
}
