/** Places on the map of stations, whose north is up.  Pure. */

const M_PER_DEG = 111_320; // of latitude, on a sphere of the Earth's size
const LEAST_M = 500; // what the map shows at least, from its left to its right
const MARGIN = 0.12; // of each side
export const ASPECT = 2; // width by height
const BAR_SHARE = 0.25; // of the width at most

export interface Anchor {
  lat_deg: number;
  lon_deg: number;
}

export interface Placed<T> {
  what: T;
  left: number; // part of the width
  top: number; // part of the height
}

export interface MapOfStations<T> {
  placed: readonly Placed<T>[];
  barM: number; // length of the scale bar
  bar: number; // part of the width
}

/** A scale that fits all places, in true proportions, as on a plane. */
export function mapOf<T extends Anchor>(all: readonly T[]): MapOfStations<T> {
  const [first] = all;
  const lon0 = first?.lon_deg ?? 0;
  const lat0 = first?.lat_deg ?? 0;
  const shrink = Math.cos((lat0 * Math.PI) / 180);
  const eastM = (one: T) => (((one.lon_deg - lon0 + 540) % 360) - 180) * shrink * M_PER_DEG;
  const northM = (one: T) => (one.lat_deg - lat0) * M_PER_DEG;
  const [west, east] = range(all.map(eastM));
  const [south, north] = range(all.map(northM));
  const widthM = Math.max(LEAST_M, east - west, ASPECT * (north - south)) / (1 - 2 * MARGIN);
  const middle = { east: (west + east) / 2, north: (south + north) / 2 };
  const placed = all.map((what) => ({
    what,
    left: 0.5 + (eastM(what) - middle.east) / widthM,
    top: 0.5 - ((northM(what) - middle.north) / widthM) * ASPECT,
  }));
  const barM = roundLength(widthM * BAR_SHARE);
  return { placed, barM, bar: barM / widthM };
}

function range(values: readonly number[]): [number, number] {
  return values.length === 0 ? [0, 0] : [Math.min(...values), Math.max(...values)];
}

/** 1, 2 or 5 of a power of ten, at most so long. */
function roundLength(metres: number): number {
  const power = 10 ** Math.floor(Math.log10(metres));
  const digit = [5, 2, 1].find((one) => one * power <= metres) ?? 1;
  return digit * power;
}
