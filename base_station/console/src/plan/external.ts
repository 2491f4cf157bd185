/** Texts of people and markers of other teams.  Pure. */
import { duration } from "../format";
import { listed } from "../language/measures";
import type { ExternalMarkerView } from "../wire";
import { t } from "../language/translate";

/** Age from which its presence is uncertain. */
export function isStale(one: ExternalMarkerView, nowMs: number): boolean {
  return nowMs >= one.stale_ms;
}

/** The name and the system that it is from; of an old one its age. */
export function externalLabel(one: ExternalMarkerView, nowMs: number): string {
  const name = one.kind === "emergency" ? t("mark.emergency", { name: one.name }) : one.name;
  const age = isStale(one, nowMs) ? [t("measure.ago", { age: duration(Math.max(nowMs - one.t_ms, 0)) })] : [];
  return t("mark.other_team", { name, source: listed([one.source, ...age]) });
}
