/** Trails that the station computes on request: the unit's own path, and the smoothed one; and with them
 * the shown one of the same time. */
import { effect, signal } from "@preact/signals";
import * as api from "../api";
import type { Picture } from "../live/picture";
import { attempt } from "../sessions";
import type { TrailPoint } from "../wire";

/** Of `fused` the console draws the last minutes anyway. */
export type TrailKind = "fused" | "raw" | "smoothed";

export const KINDS = ["fused", "raw", "smoothed"] as const satisfies readonly TrailKind[];

export interface PastTrails {
  kind: TrailKind;
  trails: ReadonlyMap<string, readonly TrailPoint[]>;
}

export const shownKinds = signal<ReadonlySet<TrailKind>>(new Set<TrailKind>(["fused"]));
export const pastTrails = signal<readonly PastTrails[]>([]);
export const loadingKinds = signal<ReadonlySet<TrailKind>>(new Set());

const AGAIN_MS = 20_000;
/** The incident whose trails are drawn: an answer may arrive after a change to another incident. */
let followed: string | null = null;

export function toggle(kind: TrailKind): void {
  const next = new Set(shownKinds.peek());
  if (!next.delete(kind)) next.add(kind);
  shownKinds.value = next;
}

/** Requests the shown trails periodically until the returned function is called. */
export function followTrails(picture: Picture): () => void {
  let timer: number | null = null;
  const stop = () => {
    if (timer !== null) clearInterval(timer);
    timer = null;
  };
  const end = effect(() => {
    const incident = picture.incident.value;
    const shown = [...shownKinds.value];
    const kinds = shown.some((kind) => kind !== "fused") ? shown : [];
    stop();
    const before = incident?.incident_id === followed ? pastTrails.peek() : [];
    followed = incident?.incident_id ?? null;
    pastTrails.value = before.filter((one) => kinds.includes(one.kind));
    if (incident === null || kinds.length === 0) return;
    const load = (some: readonly TrailKind[]) =>
      some.forEach((kind) => void ask(incident.incident_id, kind));
    load(kinds);
    // A station that takes longer than that is not asked for more and more of the same.
    const again = () => load(kinds.filter((kind) => !loadingKinds.peek().has(kind)));
    if (incident.closed_ms === null) timer = window.setInterval(again, AGAIN_MS);
  });
  return () => {
    stop();
    end();
  };
}

async function ask(incidentId: string, kind: TrailKind): Promise<void> {
  loadingKinds.value = new Set([...loadingKinds.peek(), kind]);
  const answer = await attempt(api.trails(incidentId, kind));
  loadingKinds.value = new Set([...loadingKinds.peek()].filter((one) => one !== kind));
  if (answer === null || incidentId !== followed || !shownKinds.peek().has(kind)) return;
  const trails = new Map(answer.trails.map((trail) => [trail.unit_id, trail.points]));
  pastTrails.value = [...pastTrails.peek().filter((one) => one.kind !== kind), { kind, trails }];
}
