import type VectorSource from "ol/source/Vector";

/** Without features.  One that has none already stays as it is: to clear it would draw the whole map again. */
export function emptied<T extends VectorSource>(source: T): T {
  if (source.getFeatures().length > 0) source.clear(true);
  return source;
}
