/** What an alarm's text says by a figure, as it is now: the text keeps that of when it was raised.
 * Pure. */
import type { AlarmView, UnitView } from "../wire";
import * as words from "../words";
import { isOfAnother } from "./alarms";

/** "now 4 %", or "last 4 %" where nothing newer is heard; empty where there is no figure.
 * `silent`: the station itself is not heard. */
export function figureNow(
  alarm: AlarmView,
  unit: UnitView,
  nowMs: number,
  silent: boolean,
): string {
  if (alarm.level === words.SWITCHED_OFF || isOfAnother(alarm, unit)) return "";
  const counted = (fromMs: number | null, inWords: (ms: number) => string) =>
    fromMs === null || silent ? "" : `now ${inWords(nowMs - fromMs)}`;
  const told = (figure: string) =>
    `${unit.link === "live" && !silent ? "now" : "last"} ${figure}`;
  switch (alarm.rule) {
    case "heat":
    case "heat-dose": {
      if (unit.ambient_degc === null) return "";
      const used = words.percent(unit.heat_used); // as the words say it: of the heat budget
      if (alarm.rule === "heat-dose") return told(used);
      return told(`${words.temperature(unit.ambient_degc)}, ${used}`);
    }
    case "battery": {
      const part = unit.status?.battery ?? null;
      return part === null ? "" : told(words.percent(part));
    }
    case "no-motion": {
      const stillS = unit.status?.motionless_s ?? null;
      if (stillS === null) return "";
      if (stillS < words.SAID_MOTIONLESS_S) return "has moved since";
      return told(words.duration(stillS * 1000));
    }
    case "link-lost":
      return counted(unit.last_heard_ms, words.duration);
    case words.MISSED_CHECK_IN:
      return counted(unit.duty?.checked_in_ms ?? null, words.minutes);
    case "rest-due":
      return counted(unit.duty?.work_since_ms ?? null, words.minutes);
    default:
      return "";
  }
}
