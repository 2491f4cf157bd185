/** Draws the trails that were asked for beside what is drawn anyway. */
import Feature from "ol/Feature";
import MultiLineString from "ol/geom/MultiLineString";
import VectorLayer from "ol/layer/Vector";
import VectorSource from "ol/source/Vector";
import { Stroke, Style } from "ol/style";
import type { FloorChoice } from "../view";
import type { Colours } from "./colours";
import type { PastTrails, TrailKind } from "./pastTrails";
import { TRAIL_MS, trailLines } from "./trail";

export interface PastScene {
  past: readonly PastTrails[];
  nowMs: number;
  floor: FloorChoice;
  /** The only one whose trails are drawn, from the beginning.  Null: everybody's of the last minutes;
   * all of everybody's would hide the plan. */
  chosen: string | null;
}

export class PastLayer {
  private readonly source = new VectorSource<Feature<MultiLineString>>();
  readonly layer = new VectorLayer({ source: this.source });

  show({ past, nowMs, floor, chosen }: PastScene, colours: Colours): void {
    this.source.clear(true);
    const spanMs = chosen === null ? TRAIL_MS : Infinity;
    for (const { kind, trails } of past) {
      const stroke = strokeOf(kind, colours);
      for (const [unitId, points] of trails) {
        if (chosen !== null && unitId !== chosen) continue;
        const until = points.filter(([tMs]) => tMs <= nowMs);
        const lines = trailLines(until, nowMs, floor, spanMs);
        const feature = new Feature(new MultiLineString(lines));
        feature.setStyle(new Style({ stroke }));
        this.source.addFeature(feature);
      }
    }
  }
}

/** As the legend shows it. */
function strokeOf(kind: TrailKind, colours: Colours): Stroke {
  switch (kind) {
    case "fused":
      return new Stroke({ color: colours.normal, width: 2.5 });
    case "raw":
      return new Stroke({ color: colours.quiet, width: 2, lineDash: [2, 5] });
    case "smoothed":
      return new Stroke({ color: colours.watch, width: 2.5, lineDash: [10, 4] });
  }
}
