import type VectorSource from "ol/source/Vector";

/** Clears a layer.  An empty one is left alone: clearing it would draw the whole map again. */
export function emptied<T extends VectorSource>(source: T): T {
  if (source.getFeatures().length > 0) source.clear(true);
  return source;
}
