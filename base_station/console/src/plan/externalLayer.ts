/** People and markers of other teams: diamonds with dashed regions, to distinguish them from own ones. */
import Feature from "ol/Feature";
import Circle from "ol/geom/Circle";
import Point from "ol/geom/Point";
import VectorLayer from "ol/layer/Vector";
import VectorSource from "ol/source/Vector";
import { Fill, RegularShape, Stroke, Style, Text } from "ol/style";
import type { ExternalMarkerView } from "../wire";
import { faint, type Colours } from "./colours";
import { emptied } from "./emptied";
import { externalLabel, isStale } from "./external";
import { siteCoordinate } from "./site";

const OLD_OPACITY = 0.45;
const RADIUS_PX: Record<ExternalMarkerView["kind"], number> = {
  person: 9,
  marker: 7,
  emergency: 12,
};

export interface ExternalScene {
  external: readonly ExternalMarkerView[];
  nowMs: number;
}

export class ExternalLayer {
  private readonly source = new VectorSource();
  readonly layer = new VectorLayer({ source: this.source, declutter: true });

  show({ external, nowMs }: ExternalScene, colours: Colours): void {
    emptied(this.source);
    for (const one of external) {
      const colour = colourOf(one, nowMs, colours);
      const at = siteCoordinate(one);
      if (one.radius_m !== null) {
        const region = new Feature(new Circle(at, one.radius_m));
        region.setStyle(new Style({ stroke: new Stroke({ color: colour, width: 1, lineDash: [4, 4] }) }));
        this.source.addFeature(region);
      }
      const mark = new Feature(new Point(at));
      mark.setStyle(markStyle(one, colour, nowMs, colours));
      this.source.addFeature(mark);
    }
  }
}

function colourOf(one: ExternalMarkerView, nowMs: number, colours: Colours): string {
  const colour = one.kind === "emergency" ? colours.immediate : colours.quiet;
  return isStale(one, nowMs) ? faint(colour, OLD_OPACITY) : colour;
}

function markStyle(one: ExternalMarkerView, colour: string, nowMs: number, colours: Colours): Style {
  return new Style({
    image: new RegularShape({
      points: 4,
      radius: RADIUS_PX[one.kind],
      declutterMode: "none", // a name may be hidden by another, a mark never
      fill: new Fill({ color: faint(colours.halo, 0.8) }),
      stroke: new Stroke({ color: colour, width: 2.5 }),
    }),
    text: new Text({
      text: externalLabel(one, nowMs),
      font: "italic 13px sans-serif",
      offsetY: 20,
      fill: new Fill({ color: colour }),
      stroke: new Stroke({ color: colours.halo, width: 3 }),
    }),
  });
}
