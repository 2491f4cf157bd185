/** What people did, from the audit log as the station keeps it, in words and usual units.  Pure. */
import { dateAndTime, duration, floorName } from "./format";

/** By number, as the station's messages have them (shared/messages/command.py). */
const COMMANDS = ["", "evacuate", "PAR", "message", "locate", "position rate", "reset alarm", "mayday acknowledged", "end of an order"];
/** Says nothing to a person. */
const WITHOUT_MEANING = new Set(["pin_id", "command_id", "incident_id", "person_id", "check_in_id", "entry_id", "term"]);
/** Where 0 is no number: what it stands for, and nothing where it was left out. */
const ZEROS = new Map([
  ["t_ns", "where the path begins"],
  ["after_t_ns", ""],
  ["last_raised_ms", ""],
  ["par_interval_s", ""],
  ["work_limit_s", ""],
  ["position_rate_hz", ""],
]);
const DEGREES = 180 / Math.PI;

/** Where the name alone does not say what was entered. */
const ACTIONS: Readonly<Record<string, string>> = {
  CheckIn: "PAR confirmed by radio",
  ConfirmCommand: "Order answered by radio",
  UndoConfirmation: "Answer by radio undone",
};

/** "AcknowledgeAlarm" as "Acknowledge alarm". */
export function actionWord(action: string): string {
  const special = ACTIONS[action];
  if (special !== undefined) return special;
  const words = action.replaceAll(/(?<=[a-z])(?=[A-Z])/g, " ").toLowerCase();
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/** What was sent with an action, without what was left empty; `names` are people's, by id. */
export function detailWords(detail: string, names: ReadonlyMap<string, string>): string {
  if (!detail.startsWith("{")) return withNames(detail, names);
  const values = JSON.parse(detail) as Record<string, unknown>;
  if (values["heading_rad"] === null) delete values["heading_std_rad"]; // it is of nothing
  return Object.entries(values)
    .map(([name, value]) => said(name, value))
    .filter((words) => words !== "")
    .join(", ");
}

/** People stand there by id, with the name that was given then where one was. */
function withNames(detail: string, names: ReadonlyMap<string, string>): string {
  const [id = "", ...given] = detail.split(" ");
  const name = names.get(id);
  if (name === undefined) return detail;
  return given.length === 0 ? name : given.join(" ");
}

function said(name: string, value: unknown): string {
  if (WITHOUT_MEANING.has(name) || value === "" || value === null) return "";
  if (Array.isArray(value) && value.length === 0) return "";
  if (value === 0 && ZEROS.has(name)) return ZEROS.get(name) ?? "";
  if (name === "resting") return value === true ? "to rest" : "back to work";
  if (typeof value === "boolean") return value ? spaced(name) : "";
  if (name === "floor" && typeof value === "number") return floorName(value);
  if (name === "kind" && typeof value === "number") return COMMANDS[value] ?? String(value);
  if (typeof value === "number") return quantity(name, value);
  if (name === "thresholds") return thresholds(value as Record<string, number>);
  const words = Array.isArray(value) ? value.join(" ") : String(value);
  if (name === "other_unit_id") return `met ${words}`;
  return name === "unit_id" || name === "unit_ids" ? words : `${spaced(name)}: ${words}`;
}

/** Of alarm rules, by rule and name: "no-motion.alarm_s". */
function thresholds(values: Record<string, number>): string {
  const set = Object.entries(values).map(([name, value]) => quantity(name, value));
  return set.length === 0 ? "all as usual" : set.join(", ");
}

/** A number with the unit that its name ends with. */
function quantity(name: string, value: number): string {
  const [, what = name, unit = ""] = /^(.*)_(m|s|ms|ns|deg|degc|rad|hz|days)$/.exec(name) ?? [];
  switch (unit) {
    case "m":
      return `${spaced(what)} ${rounded(value)} m`;
    case "s":
      return `${spaced(what)} ${duration(1000 * value)}`;
    case "ms":
      return `${spaced(what)} ${dateAndTime(value)}`;
    case "ns":
      return `${spaced(what)} ${dateAndTime(value / 1e6)}`;
    case "deg":
      return `${spaced(what)} ${value}°`;
    case "degc":
      return `${spaced(what)} ${value} °C`;
    case "days":
      return `${spaced(what)} ${value} days`;
    case "rad":
      return `${spaced(what)} ${rounded(value * DEGREES)}°`;
    case "hz":
      return `${spaced(what)} ${value} a second`;
    default:
      return `${spaced(name)} ${value}`;
  }
}

function rounded(value: number): string {
  return String(Math.round(10 * value) / 10);
}

function spaced(name: string): string {
  if (name === "t") return "at";
  return name.replaceAll(/[_.]/g, " ").replace(/\bstd\b/, "±").replace(/^(.*) ±$/, "± of $1");
}
