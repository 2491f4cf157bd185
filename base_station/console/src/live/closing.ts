/** Obstacles to closing an incident: open alarms of units, and people inside.  Pure. */
import type { Despite } from "../api";
import type { AlarmView, UnitView } from "../wire";
import { alarmLabel } from "../format";
import { listed } from "../language/measures";
import { t } from "../language/translate";
import { isOpen } from "./alarms";
import { displayName } from "./urgency";

/** With their ids, which the request has to name, and in words. */
export function unfinished(
  units: readonly UnitView[],
  alarms: Iterable<AlarmView>,
): Despite & { words: string } {
  const open = [...alarms].filter((alarm) => isOpen(alarm) && alarm.unit_id !== "");
  const inside = units.filter((unit) => unit.person !== null && unit.inside_since_ms !== null);
  const parts = [
    named("closing.open_alarms", byUnit(open, units)),
    named("closing.inside", inside.map(displayName)),
  ];
  return {
    despite_alarm_ids: open.map((alarm) => alarm.alarm_id),
    despite_unit_ids: inside.map((unit) => unit.unit_id),
    words: parts.filter((part) => part !== "").join(" "),
  };
}

/** "Jonas Bergman (Fall, No motion)". */
function byUnit(alarms: readonly AlarmView[], units: readonly UnitView[]): string[] {
  const words = new Map<string, string[]>();
  for (const alarm of alarms) {
    words.set(alarm.unit_id, [...(words.get(alarm.unit_id) ?? []), alarmLabel(alarm)]);
  }
  return [...words].map(([unitId, of]) => {
    const unit = units.find((one) => one.unit_id === unitId);
    return `${unit === undefined ? unitId : displayName(unit)} (${listed(of)})`;
  });
}

function named(key: "closing.open_alarms" | "closing.inside", names: readonly string[]): string {
  return names.length === 0 ? "" : t(key, { names: names.join("; ") });
}
