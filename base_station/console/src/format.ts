/** Format of numbers, short and with units.  Pure. */
import { floorNames, clock, date, degrees, length, listed, number, quantity, share } from "./language/measures";
import { knownLabel, label, t } from "./language/translate";
import type {
  AlarmView,
  ClockView,
  PositionView,
  SensorTemperatureView,
  StatusView,
  UnitView,
  WornSensorView,
} from "./wire";

/** A time that passed: "0.4 s", "42 s", "3 min 05 s", "1 h 12 min".  By the symbols of SI, which all languages
 * share: the short names of `Intl` are "3m" in one and "3 Min." in another. */
export function duration(ms: number): string {
  const seconds = Math.max(0, ms) / 1000;
  if (seconds < 10) return secondsText(number(Math.floor(seconds * 10) / 10, 1));
  if (seconds < 60) return secondsText(number(Math.floor(seconds)));
  const minutes = Math.floor(seconds / 60);
  if (minutes < 60) return `${minutesText(minutes)} ${secondsText(number(Math.floor(seconds % 60), 0, 2))}`;
  return hoursText(minutes);
}

function secondsText(value: string): string {
  return t("measure.seconds", { value });
}

function minutesText(minutes: number, leastDigits = 1): string {
  return t("measure.minutes", { value: number(minutes, 0, leastDigits) });
}

function hoursText(minutes: number): string {
  const hours = t("measure.hours", { value: number(Math.floor(minutes / 60)) });
  return `${hours} ${minutesText(minutes % 60, 2)}`;
}

/** An age, coarser with its size: "0.4 s", "42 s", "3 min", "1 h 12 min". */
export function age(ms: number): string {
  return ms < 60_000 ? duration(ms) : minutes(ms);
}

/** A long time without the seconds: "< 1 min", "12 min", "1 h 05 min". */
export function minutes(ms: number): string {
  const whole = Math.floor(Math.max(0, ms) / 60_000);
  if (whole < 1) return t("measure.under_a_minute");
  return whole < 60 ? minutesText(whole) : hoursText(whole);
}

/** A time that is left, never more than there is: "45 s", "18 min", "1 h 05 min". */
export function timeLeft(ms: number): string {
  return ms < 60_000 ? secondsText(number(Math.floor(Math.max(0, ms) / 1000))) : minutes(ms);
}

/** Minutes and seconds of a timer: "2:40", "12:40", "1:02:40". */
export function countdown(ms: number): string {
  const seconds = Math.ceil(Math.max(0, ms) / 1000);
  const minutes = Math.floor(seconds / 60);
  const rest = pad(seconds % 60);
  return minutes < 60
    ? `${minutes}:${rest}`
    : `${Math.floor(minutes / 60)}:${pad(minutes % 60)}:${rest}`;
}

const CLOCK_WRONG_MS = 10_000;

/** Place and mounting of a sensor: "left foot", "lower back (belt)". */
export function wornAt({ place, place_recognised, mount }: WornSensorView): string {
  const where = place === "" ? t("member.place_unknown") : label("worn", place);
  const how = [mount, place_recognised ? t("member.recognised") : ""].filter((word) => word !== "");
  return how.length === 0 ? where : `${where} (${how.join(", ")})`;
}

/** Offset of a unit's own clock from the station's: "40 ms ahead ± 3 ms", "1 min 15 s behind". */
export function clockOffset({ ahead_ms, std_ms }: ClockView): string {
  const way = ahead_ms < 0 ? "measure.behind" : "measure.ahead";
  return t(way, { time: briefDuration(Math.abs(ahead_ms)), std: briefDuration(std_ms) });
}

/** Offset from which times in its black box are misleading. */
export function isClockWrong({ ahead_ms }: ClockView): boolean {
  return Math.abs(ahead_ms) >= CLOCK_WRONG_MS;
}

function briefDuration(ms: number): string {
  return ms < 1000 ? t("measure.milliseconds", { value: number(Math.ceil(ms)) }) : duration(ms);
}

/** Time of the day where the console stands. */
export function clockTime(ms: number): string {
  return clock(ms);
}

/** "Nov 26, 2026, 18:42", as the locale writes it. */
export function dateAndTime(ms: number): string {
  return listed([date(ms), clock(ms, false)]);
}

/** The same with seconds. */
export function dateAndClock(ms: number): string {
  return listed([date(ms), clock(ms)]);
}

/** The same time where the day is that of `sinceMs`; else with the date: an incident lasts over midnight. */
export function timeSince(sinceMs: number, ms: number): string {
  return date(sinceMs) === date(ms) ? clock(ms) : dateAndClock(ms);
}

/** By how much the times on the screen are not those of exports and of the terminal: "UTC+5:30". */
export function zone(ms: number): string {
  const ahead = -new Date(ms).getTimezoneOffset();
  if (ahead === 0) return "UTC";
  const [hours, rest] = [Math.floor(Math.abs(ahead) / 60), Math.abs(ahead) % 60];
  return `UTC${ahead < 0 ? "−" : "+"}${hours}${rest === 0 ? "" : `:${pad(rest)}`}`;
}

/** "± 2.1 m" while that means something, whole metres above ten; in feet whole ones. */
export function plusMinus(radiusM: number): string {
  return t("measure.plus_minus", { value: length(radiusM, radiusM < 10 ? 1 : 0) });
}

export function floorName(floor: number | null): string {
  if (floor === null) return t("measure.floor_unknown");
  if (floor < 0) return t("measure.basement", { number: -floor });
  if (floorNames.value === "american") return t("measure.floor_by_ordinal", { number: floor + 1 });
  return floor === 0 ? t("measure.ground_floor") : t("measure.upper_floor", { number: floor });
}

/** On a button or a mark: "G", "1", "B1"; American "1", "2", "B1". */
export function shortFloor(floor: number): string {
  if (floor < 0) return t("measure.basement_short", { number: -floor });
  if (floorNames.value === "american") return number(floor + 1);
  return floor === 0 ? t("measure.ground_floor_short") : number(floor);
}

const FLOOR_CERTAIN = 0.95;

/** Below this probability no floor is shown: a number would be believed. */
const FLOOR_LIKELY = 0.5;

export function isFloorLikely({ floor_probability: sure }: PositionView): boolean {
  return sure === null || sure >= FLOOR_LIKELY;
}

/** The floor, with its probability if uncertain; for an old position the floor at that time. */
export function floorOf(position: PositionView, old = false): string {
  const { floor, floor_probability: sure } = position;
  if (floor === null) return floorName(floor);
  const name = old ? t("measure.floor_last", { floor: floorName(floor) }) : floorName(floor);
  if (sure === null || sure >= FLOOR_CERTAIN) return name;
  if (!isFloorLikely(position)) return t("measure.floor_doubtful", { floor: name });
  return t("measure.floor_probable", { floor: name, probability: share(sure) });
}

export function temperature(degc: number | null): string {
  return degc === null ? t("measure.no_reading") : degrees(degc);
}

const READING_OLD_MS = 10_000;

/** Whether a temperature is no longer that of now. */
export function isReadingOld(readMs: number | null, nowMs: number): boolean {
  return readMs !== null && nowMs - readMs >= READING_OLD_MS;
}

/** Readings by sensor, hottest first: "front 120 °C, back 80 °C"; of one sensor nothing. */
export function sensorsText(sensors: readonly SensorTemperatureView[]): string {
  if (sensors.length < 2) return "";
  const hottestFirst = [...sensors].sort((a, b) => b.temperature_degc - a.temperature_degc);
  return listed(hottestFirst.map((one) => `${one.name} ${temperature(one.temperature_degc)}`));
}

/** The hottest of some sensors; null: there are none. */
export function hottest(sensors: readonly SensorTemperatureView[]): number | null {
  return sensors.length === 0 ? null : Math.max(...sensors.map((one) => one.temperature_degc));
}

/** Behind the battery's level: "charging", "2 h 05 min left"; nothing where nothing is known. */
export function batteryText(status: StatusView): string {
  if (status.battery_state === "charging") return t("battery.charging");
  if (status.battery_state === "full") return t("battery.external");
  if (status.battery_left_s === null) return "";
  return t("measure.left", { time: minutes(status.battery_left_s * 1000) });
}

export function percent(part: number | null): string {
  return part === null ? t("measure.unknown") : share(part);
}

/** Shorter stillness is not shown. */
export const MOTIONLESS_SHOWN_S = 10;

/** Activity of the wearer; stillness with its duration. */
export function activityOf(unit: UnitView): string {
  const { status } = unit;
  if (status === null) return t("member.no_status");
  if (status.mayday) return t("member.mayday");
  const activity = label("activity", status.activity);
  if (status.motionless_s < MOTIONLESS_SHOWN_S) return activity;
  return t("member.motionless", { activity, age: age(status.motionless_s * 1000) });
}

/** Posture and gait; empty if the unit does not report them. */
export function postureText({ posture, posture_confidence, mobility }: StatusView): string {
  const confidence = share(posture_confidence);
  const word = knownLabel("posture", posture);
  const held = word === undefined ? undefined : t("member.posture", { posture: word, confidence });
  return listed([held, knownLabel("mobility", mobility)].filter((part) => part !== undefined));
}

export function linkText({ link, switched_off }: UnitView): string {
  return t(switched_off ? "link.switched_off" : `link.${link}`);
}

/** Time in the building; null: outside, as far as is known.  After a unit was switched off it is unknown. */
export function insideMs(unit: UnitView, nowMs: number): number | null {
  if (unit.inside_since_ms === null) return null;
  const untilMs = unit.switched_off ? (unit.last_heard_ms ?? nowMs) : nowMs;
  return untilMs - unit.inside_since_ms;
}

export function insideText(unit: UnitView): string {
  return t(unit.switched_off && unit.inside_since_ms !== null ? "member.was_inside" : "member.inside_for");
}

export function heatText(level: string): string {
  return label("heat", level === "" ? "normal" : level);
}

/** Position in words, for screen readers: "12.0 m north, 3.4 m west". */
export function place(at: { north_m: number; east_m: number }): string {
  const along = { length: length(Math.abs(at.north_m)) };
  const across = { length: length(Math.abs(at.east_m)) };
  return listed([
    at.north_m < 0 ? t("measure.south", along) : t("measure.north", along),
    at.east_m < 0 ? t("measure.west", across) : t("measure.east", across),
  ]);
}

/** Whether the position uses satellites, and the reason if not. */
export function gpsText(reason: string | null): string {
  if (reason === null) return t("member.gps_none");
  return reason === "" ? t("member.gps_used") : t("member.gps_unused", { reason: positioningReason(reason) });
}

/** Why a place is in doubt, or a fix not used: in the chosen language where the words are known. */
export function positioningReason(reason: string): string {
  return knownLabel("assessment_reason", reason) ?? reason;
}

/** The level of an alarm that only informs: the unit's silence is no loss. */
export const SWITCHED_OFF = "switched off";

/** The rule of the alarm for an overdue PAR. */
export const MISSED_CHECK_IN = "missed-check-in";

/** Prefix of earlier versions before the text of a unit, or of its tracking agent; later versions have
 * the text as a parameter. */
const FAULT_PREFIXES: Readonly<Record<string, string>> = {
  "unit-fault": "'s unit: ",
  "tracker-fault": "@tracker): ",
};
const MAX_FAULT_LENGTH = 70;

/** The kind of an alarm: "No motion", "Heat". */
export function ruleWord(rule: string): string {
  return knownLabel("alarm_label", rule) ?? inWords(rule);
}

/** An alarm in short, beside the name of its member: "Heat: warning", "Link lost".  A unit may have
 * several faults, so each is named. */
export function alarmLabel(alarm: AlarmView): string {
  const label = knownLabel("alarm_label", `${alarm.rule}/${alarm.level}`) ?? knownLabel("alarm_label", alarm.rule);
  if (label === undefined) return alarmCode(alarm);
  const fault = faultOf(alarm);
  return fault === "" ? label : `${label}: ${truncated(fault, MAX_FAULT_LENGTH)}`;
}

/** Of a rule of another version. */
function alarmCode({ rule, level }: AlarmView): string {
  const word = inWords(rule);
  return level === "alarm" || word.toLowerCase().includes(level) ? word : `${word}: ${level}`;
}

function inWords(rule: string): string {
  const words = rule.replaceAll(/[-_]/g, " ");
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/** Text of a fault by the unit or agent; empty: there is none. */
function faultOf({ rule, parameters, text }: AlarmView): string {
  const before = FAULT_PREFIXES[rule];
  if (before === undefined) return "";
  if (parameters.fault !== undefined) return parameters.fault;
  return text.includes(before) ? text.slice(text.indexOf(before) + before.length) : "";
}

export function initials(name: string): string {
  const words = name.trim().split(/\s+/);
  const letters = [words[0], words.length > 1 ? words.at(-1) : undefined];
  return letters.map((word) => [...(word ?? "")][0]?.toUpperCase() ?? "").join("");
}

const MAX_PLAN_LABEL_LENGTH = 24;

/** A name on the plan, where a long one would hide others' names and walls. */
export function planLabel(name: string): string {
  return truncated(name, MAX_PLAN_LABEL_LENGTH);
}

function truncated(text: string, most: number): string {
  const letters = [...text];
  if (letters.length <= most) return text;
  return `${letters.slice(0, most - 1).join("").trimEnd()}…`;
}

export function bytes(count: number): string {
  const units = ["byte", "kilobyte", "megabyte", "gigabyte", "terabyte"] as const;
  const step = count < 1 ? 0 : Math.min(Math.floor(Math.log10(count) / 3), units.length - 1);
  const value = count / 1000 ** step;
  return quantity(value, units[step] ?? "byte", value < 10 && step > 0 ? 1 : 0, "narrow");
}

function pad(whole: number): string {
  return String(whole).padStart(2, "0");
}
