import type { FeatureCollection } from "geojson";

/** GeoJSON whose coordinates are `[east_m, north_m]` in the incident frame; `base_station/site/plan.py`
 * describes it. */
export interface Plan extends FeatureCollection {
  muster: {
    frame: "site-m";
    name?: string;
    floors?: PlanFloor[];
    pictures?: FloorPicture[];
    damage?: string;
  };
}

export interface PlanFloor {
  floor: number;
  down_m: number;
}

/** A picture of a floor, drawn under its walls; corners are `[east_m, north_m]`. */
export interface FloorPicture {
  floor: number;
  webp: string; // base64
  upper_left_m: [number, number];
  upper_right_m: [number, number];
  lower_left_m: [number, number];
}
