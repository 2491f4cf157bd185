/** The list of all alarms: filters, and the transitions of each.  Pure. */
import type { AlarmHistoryEntry, AlarmWithLife, ResolutionReason } from "../answers";
import { knownLabel, t } from "../language/translate";
import { codedText } from "./codedText";
import { duration, minutes, MISSED_CHECK_IN, percent, temperature } from "../format";

/** Why alarms are resolved, in the order of the dialog. */
export const REASONS: readonly ResolutionReason[] = [
  "member_well",
  "found_and_helped",
  "false_alarm",
  "cause_removed",
  "unit_fault",
  "training",
  "other",
];

export interface AlarmFilter {
  unitId: string; // empty: of everybody, and of the station
  rule: string; // empty: all
  priority: number; // 0: all
  state: "all" | "open" | "resolved";
  withinMs: number; // raised, at first or again, within this time until now; Infinity: at any time
}

export const ALL_ALARMS: AlarmFilter = {
  unitId: "",
  rule: "",
  priority: 0,
  state: "all",
  withinMs: Infinity,
};

/** In the order given. */
export function filtered(
  alarms: readonly AlarmWithLife[],
  filter: AlarmFilter,
  nowMs: number,
): AlarmWithLife[] {
  const fromMs = nowMs - filter.withinMs;
  return alarms.filter(
    (alarm) =>
      (filter.unitId === "" || alarm.unit_id === filter.unitId) &&
      (filter.rule === "" || alarm.rule === filter.rule) &&
      (filter.priority === 0 || alarm.priority === filter.priority) &&
      (filter.state === "all" || (alarm.state === "resolved") === (filter.state === "resolved")) &&
      alarm.last_raised_ms >= fromMs,
  );
}

/** What happened with a change: "raised", "raised again", "now caution", "acknowledged", "resolved". */
export function changeWord(changes: readonly AlarmHistoryEntry[], at: number): string {
  const [before, change] = [changes[at - 1], changes[at]];
  if (change === undefined) return "";
  if (change.state === "acknowledged") return t("alarm_list.acknowledged");
  if (change.state === "resolved") return t("alarm_list.resolved");
  if (before === undefined) return t("alarm_list.raised");
  if (before.state !== "raised" || before.level === change.level) return t("alarm_list.raised_again");
  return t("alarm_list.now_level", { level: change.level });
}

/** User with reason and note: "mia: False alarm, stood on a ladder"; or what ended it: "cooled down". */
export function byWords({ by, reason, note }: AlarmHistoryEntry): string {
  const chosen = knownLabel("alarm_reason", reason);
  if (chosen === undefined && note === "") return codedText({ code: reason, texts: {}, numbers: {} }, by);
  const why = [chosen ?? "", note].filter((word) => word !== "");
  return why.length === 0 ? by : `${by}: ${why.join(", ")}`;
}

/** The worst that was measured, in the unit of the rule; empty: the rule measures nothing. */
export function peakText({ rule, peak }: Pick<AlarmWithLife, "rule" | "peak">): string {
  if (peak === null) return "";
  switch (rule) {
    case "heat":
      return temperature(peak);
    case "heat-dose":
    case "battery":
      return percent(peak);
    case MISSED_CHECK_IN:
    case "rest-due":
      return minutes(peak * 1000);
    default:
      return duration(peak * 1000);
  }
}
