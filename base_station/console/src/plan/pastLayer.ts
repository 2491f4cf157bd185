/** Draws the trails that were asked for beside what is drawn anyway. */
import Feature from "ol/Feature";
import MultiLineString from "ol/geom/MultiLineString";
import VectorLayer from "ol/layer/Vector";
import VectorSource from "ol/source/Vector";
import { Stroke, Style } from "ol/style";
import type { FloorChoice } from "../view";
import type { Colours } from "./colours";
import type { PastKind, PastTrails } from "./pastTrails";
import { trailLines } from "./trail";

export class PastLayer {
  private readonly source = new VectorSource<Feature<MultiLineString>>();
  readonly layer = new VectorLayer({ source: this.source });

  show(all: readonly PastTrails[], nowMs: number, floor: FloorChoice, colours: Colours): void {
    this.source.clear(true);
    for (const { kind, trails } of all) {
      for (const points of trails.values()) {
        const until = points.filter(([tMs]) => tMs <= nowMs);
        const lines = trailLines(until, nowMs, floor, Infinity);
        const feature = new Feature(new MultiLineString(lines));
        feature.setStyle(new Style({ stroke: strokeOf(kind, colours) }));
        this.source.addFeature(feature);
      }
    }
  }
}

/** As the legend shows it. */
function strokeOf(kind: PastKind, colours: Colours): Stroke {
  if (kind === "raw") return new Stroke({ color: colours.quiet, width: 2, lineDash: [2, 5] });
  return new Stroke({ color: colours.watch, width: 2.5, lineDash: [10, 4] });
}
