/** The picture of the ground about the site: where its corners are, on the Earth and on the plan. */
import { effect, signal } from "@preact/signals";
import * as api from "../api";
import type { BaseMap, LatLon } from "../api";
import type { AnchorView } from "../wire";
import { siteOf } from "./anchor";
import { PictureLayer } from "./pictureLayer";
import type { Place } from "./tools";

export const baseMap = signal<BaseMap | null>(null);

/** Other consoles may set and remove it; live pictures do not contain it. */
export const AGAIN_MS = 20_000;

/** Requests it periodically until the returned function is called. */
export function keepBaseMap(): () => void {
  const look = () => void lookAgain().catch(() => undefined); // the one that is shown stays
  look();
  const timer = setInterval(look, AGAIN_MS);
  return () => clearInterval(timer);
}

async function lookAgain(): Promise<void> {
  const before = baseMap.peek();
  const now = await api.baseMap();
  const isSetHere = baseMap.peek() !== before;
  if (!isSetHere && JSON.stringify(now) !== JSON.stringify(before)) baseMap.value = now;
}

/** The six numbers of a world file, one a line; null where it is none. */
export function worldOf(text: string): number[] | null {
  const numbers = text.trim().split(/\s+/).map(Number);
  return numbers.length === 6 && numbers.every(Number.isFinite) ? numbers : null;
}

/** The grid of a world file: as given by its number, else degrees where they can be, else metres of
 * the web's maps. */
export function crsOf(epsg: string, world: readonly number[]): string {
  if (epsg !== "") return `EPSG:${epsg}`;
  return world.slice(4).some((value) => Math.abs(value) > 180) ? "EPSG:3857" : "EPSG:4326";
}

/** Place on the Earth of a point of the picture, given from the left and from the top. */
export function earthAt(map: BaseMap, across: number, down: number): LatLon {
  const along = (axis: 0 | 1) =>
    map.upper_left[axis] +
    across * (map.upper_right[axis] - map.upper_left[axis]) +
    down * (map.lower_left[axis] - map.upper_left[axis]);
  return [along(0), along(1)];
}

/** The three corners in site metres. */
export function cornersOf(map: BaseMap, anchor: AnchorView): [Place, Place, Place] {
  const at = ([lat, lon]: LatLon) => siteOf(anchor, lat, lon);
  return [at(map.upper_left), at(map.upper_right), at(map.lower_left)];
}

/** Drawn behind the plan, once it is known where the plan lies. */
export class BaseMapLayer extends PictureLayer {
  constructor() {
    super("base-map", 0.55);
  }

  show(map: BaseMap | null, anchor: AnchorView | null): void {
    const corners = map === null || anchor === null ? null : cornersOf(map, anchor);
    this.place(map?.image_url ?? null, corners);
  }
}

/** Keeps the layer up to date. */
export function followBaseMap(layer: BaseMapLayer, anchor: () => AnchorView | null): () => void {
  return effect(() => layer.show(baseMap.value, anchor()));
}
