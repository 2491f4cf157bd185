/** Imported files of the shown incident: tracks and photographs, by time. */
import { effect, signal } from "@preact/signals";
import { importedFiles, importedTracks } from "../importedFiles";
import type { ImportedTracks } from "../importedFiles";
import type { Picture } from "../live/picture";
import type { TrailPoint } from "../wire";

export const imports = signal<readonly ImportedTracks[]>([]);
export const areImportsShown = signal(true);
/** Whether the station could not list the imports. */
export const importsFailed = signal(false);
/** Counts up with each import and removal. */
export const importsChanged = signal(0);

/** Age from which the last point of a track is no current position. */
const LAST_PLACE_MS = 60_000;

/** The shown incident: an answer may arrive after a change to another one. */
let followed = "";

/** Requests them after each change of the incident until the returned function is called. */
export function followImports(picture: Picture): () => void {
  return effect(() => {
    const incidentId = picture.incident.value?.incident_id ?? "";
    const asked = `${incidentId} ${importsChanged.value}`;
    if (asked === followed) return;
    if (!followed.startsWith(`${incidentId} `)) imports.value = [];
    followed = asked;
    importsFailed.value = false;
    if (incidentId !== "") void ask(incidentId, asked);
  });
}

async function ask(incidentId: string, asked: string): Promise<void> {
  try {
    const files = (await importedFiles(incidentId)).filter((file) => file.is_here);
    const found: ImportedTracks[] = [];
    for (const { import_id } of files) {
      found.push(await importedTracks(incidentId, import_id)); // one by one: they may be large
      if (followed !== asked) return;
      imports.value = [...found];
    }
    if (followed === asked) imports.value = found;
  } catch {
    if (followed === asked) importsFailed.value = true;
  }
}

/** How many points of a track are at or before a time. */
export function countUntil(points: readonly TrailPoint[], untilMs: number): number {
  let [low, high] = [0, points.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((points[middle]?.[0] ?? Infinity) <= untilMs) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** The last point at or before a time; null: there is none, or it is old. */
export function placeAt(points: readonly TrailPoint[], nowMs: number): TrailPoint | null {
  const last = points[countUntil(points, nowMs) - 1];
  return last === undefined || nowMs - last[0] > LAST_PLACE_MS ? null : last;
}
