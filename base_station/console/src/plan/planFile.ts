import type { FeatureCollection } from "geojson";

/** GeoJSON whose coordinates are `[east_m, north_m]` in the incident frame; `base_station/site/plan.py`
 * says more. */
export interface Plan extends FeatureCollection {
  muster: { frame: "site-m"; name?: string; floors?: PlanFloor[]; damage?: string };
}

export interface PlanFloor {
  floor: number;
  down_m: number;
}
