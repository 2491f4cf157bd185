/** Words for people and markers of other teams.  Pure. */
import { duration } from "../format";
import type { ExternalMarkerView } from "../wire";

/** From then on nobody knows whether it is still there. */
export function isStale(one: ExternalMarkerView, nowMs: number): boolean {
  return nowMs >= one.stale_ms;
}

/** The name and the system that it is from; of an old one its age. */
export function externalLabel(one: ExternalMarkerView, nowMs: number): string {
  const name = one.kind === "emergency" ? `EMERGENCY ${one.name}` : one.name;
  const age = isStale(one, nowMs) ? `, ${duration(Math.max(nowMs - one.t_ms, 0))} ago` : "";
  return `${name} (${one.source}${age})`;
}
