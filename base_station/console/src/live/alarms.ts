/** Open alarms in the order of their urgency. */
import type { AlarmView, UnitView } from "../wire";
import { alarmLabel, MISSED_CHECK_IN } from "../format";
import { listed } from "../language/measures";
import { t } from "../language/translate";
import { alarmText } from "./alarmText";
import { displayName } from "./urgency";

export function isOpen(alarm: Pick<AlarmView, "state">): boolean {
  return alarm.state !== "resolved";
}

/** Highest priority first, then unacknowledged ones, then the oldest. */
export function openAlarms(alarms: Iterable<AlarmView>): AlarmView[] {
  return [...alarms]
    .filter(isOpen)
    .sort(
      (a, b) =>
        a.priority - b.priority ||
        Number(a.state === "acknowledged") - Number(b.state === "acknowledged") ||
        a.raised_ms - b.raised_ms ||
        (a.alarm_id < b.alarm_id ? -1 : 1),
    );
}

/** Whether an alarm of this rule is open about the unit; the station decides the threshold. */
export function hasAlarm(
  unit: UnitView,
  rule: string,
  alarms: ReadonlyMap<string, AlarmView>,
): boolean {
  return unit.alarms.some((alarmId) => alarms.get(alarmId)?.rule === rule);
}

/** Time of the last raising: an alarm that recurs or gets worse is raised again. */
export function sinceMs({ state, raised_ms, last_raised_ms }: AlarmView): number {
  return state === "raised" ? last_raised_ms : raised_ms;
}

/** Rules about a person: their alarms stay with the person when the unit is reassigned. */
const OF_WEARER = ["mayday", "fall", "no-motion", MISSED_CHECK_IN, "rest-due"];

/** Whether the alarm is of a previous wearer of the unit. */
export function isOfAnother(alarm: AlarmView, unit: UnitView): boolean {
  return OF_WEARER.includes(alarm.rule) && handedTo(alarm, unit) !== "";
}

/** Urgent alarms of the current wearer, except an overdue PAR. */
export function needsOf(unit: UnitView, alarms: ReadonlyMap<string, AlarmView>): AlarmView[] {
  return unit.alarms
    .map((alarmId) => alarms.get(alarmId))
    .filter((alarm) => alarm !== undefined)
    .filter((alarm) => alarm.priority === 1 && alarm.rule !== MISSED_CHECK_IN)
    .filter((alarm) => !isOfAnother(alarm, unit));
}

/** Those units that have an open emergency alarm, with its alarms: "Jonas Bergman (Fall, No motion)". */
export function inAlarm(
  units: readonly UnitView[],
  alarms: ReadonlyMap<string, AlarmView>,
): string[] {
  return units.flatMap((unit) => {
    const needs = needsOf(unit, alarms);
    return needs.length === 0 ? [] : [`${displayName(unit)} (${listed(needs.map(alarmLabel))})`];
  });
}

/** Of Bo, Bob is not named. */
function wholeWord(name: string): RegExp {
  const letters = name.replace(/[\\^$.*+?()[\]{}|/]/g, "\\$&");
  return new RegExp(`(?<![\\p{L}\\p{N}])${letters}(?![\\p{L}\\p{N}])`, "u");
}

/** Current wearer of the unit, if the alarm was raised for another one; else empty. */
export function handedTo(alarm: AlarmView, unit: UnitView): string {
  const name = displayName(unit);
  if (wholeWord(name).test(alarmText(alarm))) return "";
  return unit.person === null ? t("alarm.unit_unassigned") : t("alarm.unit_of", { name });
}
