/** Entries of the audit log in words and usual units.  Pure. */
import { knownLabel, type PlainKey, t } from "./language/translate";
import { dateAndTime, duration, floorName } from "./format";
import { degrees, length, listed, number } from "./language/measures";

/** By number, as the station's messages have them (shared/messages/command.py). */
const COMMANDS: readonly (PlainKey | "")[] = [
  "",
  "order.evacuate",
  "order.par_request",
  "order.text",
  "order.locate",
  "order.set_position_rate",
  "audit_value.reset_alarm",
  "order.mayday_acknowledged",
  "audit_value.end_of_order",
  "order.alarm_acknowledged",
  "order.all_clear",
];
/** Fields without meaning for users. */
const WITHOUT_MEANING = new Set(["pin_id", "command_id", "incident_id", "person_id", "check_in_id", "entry_id", "ended_command_id", "term"]);
/** Fields in which 0 means omitted. */
const ZEROS = new Set(["after_t_ns", "last_raised_ms", "par_interval_s", "work_limit_s", "position_rate_hz"]);
/** Fields in which 0 means the start of the path. */
const FROM_START = "t_ns";
const DEGREES = 180 / Math.PI;

/** "AcknowledgeAlarm" as "Acknowledge alarm". */
export function actionWord(action: string): string {
  const known = knownLabel("audit_action", action);
  if (known !== undefined) return known; // else of another version
  const words = action.replaceAll(/(?<=[a-z])(?=[A-Z])/g, " ").toLowerCase();
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/** Fields of an action without the empty ones; `names` are those of people, by id. */
export function detailWords(detail: string, names: ReadonlyMap<string, string>): string {
  if (!detail.startsWith("{")) return withNames(detail, names);
  const values = JSON.parse(detail) as Record<string, unknown>;
  if (values["heading_rad"] === null) delete values["heading_std_rad"]; // it is of nothing
  const all = Object.entries(values)
    .map(([name, value]) => said(name, value))
    .filter((words) => words !== "");
  return listed(all);
}

/** Fields with a person's id, shown with the name at that time if there was one. */
function withNames(detail: string, names: ReadonlyMap<string, string>): string {
  const [id = "", ...given] = detail.split(" ");
  const name = names.get(id);
  if (name === undefined) return detail;
  return given.length === 0 ? name : given.join(" ");
}

function said(name: string, value: unknown): string {
  if (WITHOUT_MEANING.has(name) || value === "" || value === null) return "";
  if (Array.isArray(value) && value.length === 0) return "";
  if (value === 0 && name === FROM_START) return t("audit_value.start");
  if (value === 0 && ZEROS.has(name)) return "";
  if (name === "repeats") return t("audit_value.sent_again");
  if (name === "resting") return t(value === true ? "audit_value.to_rehab" : "audit_value.return_to_duty");
  if (typeof value === "boolean") return value ? fieldWord(name) : "";
  if (name === "floor" && typeof value === "number") return floorName(value);
  if (name === "kind" && typeof value === "number") return commandWord(value);
  if (typeof value === "number") return quantity(name, value);
  if (name === "thresholds") return thresholds(value as Record<string, number>);
  const words = Array.isArray(value) ? value.join(" ") : String(value);
  if (name === "other_unit_id") return t("audit_value.same_place", { unit: words });
  return name === "unit_id" || name === "unit_ids" ? words : t("audit_value.named", { field: fieldWord(name), value: words });
}

/** Of alarm rules, by rule and name: "no-motion.alarm_s". */
function thresholds(values: Record<string, number>): string {
  const set = Object.entries(values).map(([name, value]) => quantity(name, value));
  return set.length === 0 ? t("audit_value.default_thresholds") : listed(set);
}

function commandWord(kind: number): string {
  const key = COMMANDS[kind] ?? "";
  return key === "" ? String(kind) : t(key);
}

/** A number with the unit that its name ends with. */
function quantity(name: string, value: number): string {
  const [, what = name, unit = ""] = /^(.*)_(m|s|ms|ns|deg|degc|rad|hz|days)$/.exec(name) ?? [];
  const field = fieldWord(unit === "" ? name : what);
  return t("audit_value.with_number", { field, value: valueWord(unit, value) });
}

function valueWord(unit: string, value: number): string {
  switch (unit) {
    case "m":
      return length(value, roundDigits(value));
    case "s":
      return duration(1000 * value);
    case "ms":
      return dateAndTime(value);
    case "ns":
      return dateAndTime(value / 1e6);
    case "deg":
      return `${plain(value)}°`;
    case "degc":
      return degrees(value);
    case "days":
      return t("audit_value.days", { count: value });
    case "rad":
      return `${number(value * DEGREES, roundDigits(value * DEGREES))}°`;
    case "hz":
      return t("audit_value.rate", { value: plain(value) });
    default:
      return plain(value);
  }
}

/** With one digit behind the point where that is none of zero. */
function roundDigits(value: number): number {
  return Math.round(10 * value) % 10 === 0 ? 0 : 1;
}

/** As it was entered. */
function plain(value: number): string {
  return number(value, String(value).split(".")[1]?.length ?? 0);
}

/** The name of a field; an unknown one as the station names it. */
function fieldWord(name: string): string {
  return knownLabel("audit_field", name) ?? spaced(name);
}

function spaced(name: string): string {
  return name.replaceAll(/[_.]/g, " ");
}
