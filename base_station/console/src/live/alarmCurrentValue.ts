/** Current value of the quantity in an alarm's text, which keeps the value at the raising. Pure. */
import type { AlarmView, UnitView } from "../wire";
import * as format from "../format";
import { listed } from "../language/measures";
import { t } from "../language/translate";
import { isOfAnother } from "./alarms";

/** "now 4 %", or "last 4 %" without a newer value; empty for an alarm without a value. `silent`: the
 * station itself is not received. */
export function alarmCurrentValue(
  alarm: AlarmView,
  unit: UnitView,
  nowMs: number,
  silent: boolean,
): string {
  if (alarm.level === format.SWITCHED_OFF || isOfAnother(alarm, unit)) return "";
  const counted = (fromMs: number | null, inWords: (ms: number) => string) =>
    fromMs === null || silent ? "" : t("alarm.now", { value: inWords(nowMs - fromMs) });
  const withValue = (value: string) =>
    t(unit.link === "live" && !silent ? "alarm.now" : "alarm.last", { value });
  switch (alarm.rule) {
    case "heat":
    case "heat-dose": {
      if (unit.ambient_degc === null) return "";
      const used = format.percent(unit.heat_used); // as the words say it: of the heat budget
      if (alarm.rule === "heat-dose") return withValue(used);
      return withValue(listed([format.temperature(unit.ambient_degc), used]));
    }
    case "battery": {
      const part = unit.status?.battery ?? null;
      return part === null ? "" : withValue(format.percent(part));
    }
    case "no-motion": {
      const stillS = unit.status?.motionless_s ?? null;
      if (stillS === null) return "";
      if (stillS < format.MOTIONLESS_SHOWN_S) return t("alarm.has_moved");
      return withValue(format.duration(stillS * 1000));
    }
    case "link-lost":
      return counted(unit.last_heard_ms, format.duration);
    case format.MISSED_CHECK_IN:
      return counted(unit.duty?.checked_in_ms ?? unit.duty?.on_duty_ms ?? null, format.minutes);
    case "rest-due":
      return counted(unit.duty?.work_since_ms ?? null, format.minutes);
    default:
      return "";
  }
}
