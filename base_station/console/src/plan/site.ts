/** The incident frame as a map projection: metres, x east and y north. */
import { Projection } from "ol/proj";

export const SITE = new Projection({ code: "MUSTER-SITE", units: "m", global: false });

export function siteCoordinate(at: { east_m: number; north_m: number }): [number, number] {
  return [at.east_m, at.north_m];
}
