/** Layer of requested trails beside the live ones. */
import Feature from "ol/Feature";
import MultiLineString from "ol/geom/MultiLineString";
import VectorLayer from "ol/layer/Vector";
import VectorSource from "ol/source/Vector";
import { Stroke, Style } from "ol/style";
import type { FloorChoice } from "../uiState";
import { emptied } from "./emptied";
import type { Colours } from "./colours";
import type { PastTrails, TrailKind } from "./pastTrails";
import type { TrailPoint } from "../wire";
import { joinedByTime, spanMs, trailLines } from "./trail";

export interface PastScene {
  past: readonly PastTrails[];
  /** The trails as they are drawn anyway: of what was shown, only what lies before them is missing. */
  shown: ReadonlyMap<string, readonly TrailPoint[]>;
  nowMs: number;
  floor: FloorChoice;
  chosen: string | null; // the only one whose trails are drawn; null: everybody's
}

export class PastLayer {
  private readonly source = new VectorSource<Feature<MultiLineString>>();
  readonly layer = new VectorLayer({ source: this.source });

  show({ past, shown, nowMs, floor, chosen }: PastScene, colours: Colours): void {
    emptied(this.source);
    for (const { kind, trails } of past) {
      const stroke = strokeOf(kind, colours);
      for (const [unitId, points] of trails) {
        if (chosen !== null && unitId !== chosen) continue;
        const endMs = kind === "fused" ? (shown.get(unitId)?.[0]?.[0] ?? nowMs) : nowMs;
        const until = points.filter(([tMs]) => tMs <= endMs);
        const lines = trailLines(until, nowMs, floor, spanMs(chosen !== null), joinedByTime);
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
      return new Stroke({ color: colours.chosen, width: 3.5 });
    case "raw":
      return new Stroke({ color: colours.quiet, width: 2, lineDash: [2, 5] });
    case "smoothed":
      return new Stroke({ color: colours.watch, width: 2.5, lineDash: [10, 4] });
  }
}
