/** Numbers as a tired person reads them.  Pure. */
import type {
  AlarmView,
  ClockView,
  ForwarderView,
  HealthView,
  Link,
  PositionView,
  PreflightView,
  SensorTemperatureView,
  StatusView,
  UnitView,
  WornSensorView,
} from "./wire";

/** A time that passed: "0.4 s", "42 s", "3 min 05 s", "1 h 12 min". */
export function duration(ms: number): string {
  const seconds = Math.max(0, ms) / 1000;
  if (seconds < 10) return `${(Math.floor(seconds * 10) / 10).toFixed(1)} s`;
  if (seconds < 60) return `${Math.floor(seconds)} s`;
  const minutes = Math.floor(seconds / 60);
  if (minutes < 60) return `${minutes} min ${pad(Math.floor(seconds % 60))} s`;
  return `${Math.floor(minutes / 60)} h ${pad(minutes % 60)} min`;
}

/** How old something is, as coarse as it is old: "0.4 s", "42 s", "3 min", "1 h 12 min". */
export function age(ms: number): string {
  return ms < 60_000 ? duration(ms) : minutes(ms);
}

/** A long time without the seconds: "< 1 min", "12 min", "1 h 05 min". */
export function minutes(ms: number): string {
  const whole = Math.floor(Math.max(0, ms) / 60_000);
  if (whole < 1) return "< 1 min";
  return whole < 60 ? `${whole} min` : `${Math.floor(whole / 60)} h ${pad(whole % 60)} min`;
}

/** Minutes and seconds as on a kitchen clock: "12:40", "1:02:40". */
export function countdown(ms: number): string {
  const seconds = Math.ceil(Math.max(0, ms) / 1000);
  const minutes = Math.floor(seconds / 60);
  const rest = pad(seconds % 60);
  return minutes < 60
    ? `${pad(minutes)}:${rest}`
    : `${Math.floor(minutes / 60)}:${pad(minutes % 60)}:${rest}`;
}

const CLOCK_WRONG_MS = 10_000;

/** What a unit has found wrong when it checked itself at its start. */
export function preflightText({ level, text }: PreflightView): string {
  return `${level === "failed" ? "not ready" : "with warnings"}: ${text}`;
}

/** Where a sensor is worn, and how: "left foot", "lower back (belt)". */
export function wornAt({ place, place_recognised, mount }: WornSensorView): string {
  const where = place === "" ? "place not known" : place.replaceAll("_", " ");
  const how = [mount, place_recognised ? "recognised" : ""].filter((word) => word !== "");
  return how.length === 0 ? where : `${where} (${how.join(", ")})`;
}

/** How far a unit's own clock is from the station's: "40 ms ahead ± 3 ms", "1 min 15 s behind". */
export function clockOffset({ ahead_ms, std_ms }: ClockView): string {
  const way = ahead_ms < 0 ? "behind" : "ahead";
  return `${briefDuration(Math.abs(ahead_ms))} ${way} ±\u00a0${briefDuration(std_ms)}`;
}

/** Far enough for times in its black box to mislead. */
export function isClockWrong({ ahead_ms }: ClockView): boolean {
  return Math.abs(ahead_ms) >= CLOCK_WRONG_MS;
}

function briefDuration(ms: number): string {
  return ms < 1000 ? `${Math.ceil(ms)}\u00a0ms` : duration(ms);
}

/** Time of the day where the console stands. */
export function clockTime(ms: number): string {
  const at = new Date(ms);
  return [at.getHours(), at.getMinutes(), at.getSeconds()].map(pad).join(":");
}

export function dateAndTime(ms: number): string {
  const at = new Date(ms);
  const date = [at.getFullYear(), at.getMonth() + 1, at.getDate()].map(pad).join("-");
  return `${date} ${clockTime(ms).slice(0, 5)}`;
}

/** The same time where the day is that of `sinceMs`; else with the date: an incident lasts over midnight. */
export function timeSince(sinceMs: number, ms: number): string {
  const [since, at] = [dateAndTime(sinceMs), dateAndTime(ms)].map((one) => one.slice(0, 10));
  return since === at ? clockTime(ms) : `${at} ${clockTime(ms)}`;
}

/** By how much the times on the screen are not those of exports and of the terminal: "UTC+5:30". */
export function zone(ms: number): string {
  const ahead = -new Date(ms).getTimezoneOffset();
  if (ahead === 0) return "UTC";
  const [hours, rest] = [Math.floor(Math.abs(ahead) / 60), Math.abs(ahead) % 60];
  return `UTC${ahead < 0 ? "−" : "+"}${hours}${rest === 0 ? "" : `:${pad(rest)}`}`;
}

/** "± 2.1 m" while that means something, whole metres above ten. */
export function plusMinus(radiusM: number): string {
  return `±\u00a0${radiusM < 10 ? radiusM.toFixed(1) : Math.round(radiusM)}\u00a0m`;
}

export function floorName(floor: number | null): string {
  if (floor === null) return "floor unknown";
  if (floor === 0) return "ground floor";
  return floor > 0 ? `floor ${floor}` : `basement ${-floor}`;
}

const FLOOR_CERTAIN = 0.95;

/** Less probable than this, no floor is said: a number would be believed. */
const FLOOR_LIKELY = 0.5;

export function isFloorLikely({ floor_probability: sure }: PositionView): boolean {
  return sure === null || sure >= FLOOR_LIKELY;
}

/** The floor, and how sure that is where there is a doubt; of an old position it is that of then. */
export function floorOf(position: PositionView, old = false): string {
  const { floor, floor_probability: sure } = position;
  if (floor === null) return floorName(floor);
  const name = old ? `last on ${floorName(floor)}` : floorName(floor);
  if (sure === null || sure >= FLOOR_CERTAIN) return name;
  if (!isFloorLikely(position)) return `floor unknown, perhaps ${name}`;
  return `${name} (${Math.round(100 * sure)} % sure)`;
}

export function temperature(degc: number | null): string {
  return degc === null ? "no reading" : `${Math.round(degc)}\u00a0°C`;
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
  return hottestFirst.map((one) => `${one.name} ${temperature(one.temperature_degc)}`).join(", ");
}

/** The hottest of some sensors; null: there are none. */
export function hottest(sensors: readonly SensorTemperatureView[]): number | null {
  return sensors.length === 0 ? null : Math.max(...sensors.map((one) => one.temperature_degc));
}

/** Behind the battery's level: "charging", "2 h 05 min left"; nothing where nothing is known. */
export function batteryText(status: StatusView): string {
  if (status.battery_state === "charging") return "charging";
  if (status.battery_state === "full") return "on external power";
  if (status.battery_left_s === null) return "";
  return `${minutes(status.battery_left_s * 1000)} left`;
}

export function percent(part: number | null): string {
  return part === null ? "unknown" : `${Math.round(part * 100)}\u00a0%`;
}

export const ACTIVITIES: Record<string, string> = {
  unknown: "Unknown",
  still: "Still",
  walking: "Walking",
  running: "Running",
  stairs_up: "Stairs up",
  stairs_down: "Stairs down",
  crawling: "Crawling",
  lying: "Lying",
  falling: "Falling",
};

/** Less is no stillness that anybody would speak of. */
export const MOTIONLESS_SHOWN_S = 10;

/** What the wearer does; stillness says for how long. */
export function activityOf(unit: UnitView): string {
  const { status } = unit;
  if (status === null) return "No status";
  if (status.mayday) return "MAYDAY";
  const word = ACTIVITIES[status.activity] ?? status.activity;
  if (status.motionless_s < MOTIONLESS_SHOWN_S) return word;
  return `${word}, motionless ${age(status.motionless_s * 1000)}`;
}

const POSTURES: Record<string, string> = {
  upright: "Upright",
  standing: "Standing",
  sitting: "Sitting",
  kneeling: "Kneeling",
  crawling: "On hands and knees",
  bent: "Bent forward",
  lying: "Lying",
  prone: "Lying face down",
  supine: "Lying on the back",
  left_side: "Lying on the left side",
  right_side: "Lying on the right side",
};

const MOBILITIES: Record<string, string> = {
  backward: "going backward",
  leftward: "stepping to the left",
  rightward: "stepping to the right",
  turning: "turning on the spot",
};

/** How the body is held and goes; empty where the unit does not tell it. */
export function postureText({ posture, posture_confidence, mobility }: StatusView): string {
  const word = POSTURES[posture];
  const held = word === undefined ? [] : [`${word} (${Math.round(posture_confidence * 100)} %)`];
  return [...held, MOBILITIES[mobility] ?? ""].filter((part) => part !== "").join(", ");
}

const LINKS: Record<Link, string> = {
  live: "Link good",
  stale: "Link stale",
  lost: "Link lost",
  never: "Never heard",
};

/** Of a unit whose name two machines use. */
export const DUPLICATE_DEVICE = "two machines speak under this name; only one is shown";

export function linkText({ link, switched_off }: UnitView): string {
  return switched_off ? "Switched off" : LINKS[link];
}

/** For how long the wearer is in the building; null: outside, as far as is known.  What became of them
 * since their unit was switched off nobody knows. */
export function insideMs(unit: UnitView, nowMs: number): number | null {
  if (unit.inside_since_ms === null) return null;
  const untilMs = unit.switched_off ? (unit.last_heard_ms ?? nowMs) : nowMs;
  return untilMs - unit.inside_since_ms;
}

export function insideText(unit: UnitView): string {
  return unit.switched_off && unit.inside_since_ms !== null ? "Was inside" : "Inside for";
}

const HEAT: Record<string, string> = {
  "": "normal",
  caution: "caution",
  warning: "warning",
  critical: "CRITICAL",
};

export function heatText(level: string): string {
  return HEAT[level] ?? level;
}

/** Where that is, for who does not see the plan: "12.0 m north, 3.4 m west". */
export function place(at: { north_m: number; east_m: number }): string {
  const along = `${Math.abs(at.north_m).toFixed(1)} m ${at.north_m < 0 ? "south" : "north"}`;
  return `${along}, ${Math.abs(at.east_m).toFixed(1)} m ${at.east_m < 0 ? "west" : "east"}`;
}

/** What is wrong with the station, sentence by sentence. */
export function problemsOf(health: HealthView): string[] {
  if (!health.insecure) return health.problems;
  return [...health.problems, "Not encrypted: others on the network can listen and speak"];
}

/** Whether somebody's place goes by satellites, and why not. */
export function gpsText(reason: string | null): string {
  if (reason === null) return "no fix yet";
  return reason === "" ? "used" : `not used: ${reason}`;
}

/** The level of an alarm that only informs: the unit's silence is no loss. */
export const SWITCHED_OFF = "switched off";

/** The rule of the alarm that nobody has heard from somebody in time. */
export const MISSED_CHECK_IN = "missed-check-in";

/** What the station puts before the own words of a unit, or of the agent that tracks for one
 * (base_station/core/alarms/unit_fault.py, tracker_fault.py). */
const FAULT_PREFIXES: Readonly<Record<string, string>> = {
  "unit-fault": "'s unit: ",
  "tracker-fault": "@tracker): ",
};
const MAX_FAULT_LENGTH = 70;

/** An alarm in short, for a place that says already whose it is: "Heat: warning", "Link lost".  A unit
 * may have several faults, so each says which it is. */
export function alarmLabel(alarm: AlarmView): string {
  if (alarm.level === SWITCHED_OFF) return "Switched off"; // its link is not lost
  if (alarm.rule === MISSED_CHECK_IN) return "Missed check-in"; // it has no other level
  const rule = alarm.rule.replaceAll(/[-_]/g, " ").replace(/^gps\b/, "GPS");
  const word = rule.charAt(0).toUpperCase() + rule.slice(1);
  const before = FAULT_PREFIXES[alarm.rule];
  if (before !== undefined && alarm.text.includes(before)) {
    const own = alarm.text.slice(alarm.text.indexOf(before) + before.length);
    return `${word}: ${truncated(own, MAX_FAULT_LENGTH)}`;
  }
  return alarm.level === "alarm" || rule.includes(alarm.level) ? word : `${word}: ${alarm.level}`;
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
  const units = ["B", "kB", "MB", "GB", "TB"];
  const step = count < 1 ? 0 : Math.min(Math.floor(Math.log10(count) / 3), units.length - 1);
  const value = count / 1000 ** step;
  return `${value < 10 && step > 0 ? value.toFixed(1) : Math.round(value)} ${units[step]}`;
}

function pad(whole: number): string {
  return String(whole).padStart(2, "0");
}

const FORWARDER_STATES: Record<ForwarderView["state"], string> = {
  connected: "connected",
  connecting: "not connected",
  standby: "the other station forwards",
};

/** A connection with another system in one line. */
export function forwarderLine(one: ForwarderView): string {
  const state = FORWARDER_STATES[one.state];
  const line = `${one.kind.toUpperCase()} ${one.name} (${one.address}): ${state}`;
  const sent = `${one.sent.toLocaleString("en")} events sent`;
  const received = `${one.received.toLocaleString("en")} received`;
  const refused = one.refused > 0 ? `${one.refused.toLocaleString("en")} left out` : "";
  return [line, sent, received, refused, one.text].filter(Boolean).join("; ");
}
