/** Texts by the codes and parameters of the station.  Pure. */
import { bytes, dateAndTime, duration, minutes, percent, temperature } from "../format";
import type { PartName, DeferredPart } from "../language/catalogue";
import { far, length, listed, number } from "../language/measures";
import { knownLabel, knownMessage, label, t } from "../language/translate";
import type { HealthView, PreflightView, TextCodeView } from "../wire";

/** The parts with texts of the station and of its units; each code is in one of them. */
const PARTS = [
  "problem",
  "unit_fault",
  "unit_check",
  "coded_reason",
  "drawing_note",
  "pin_reason",
  "transfer_problem",
  "connection_reason",
  "dispatch_warning",
  "import_warning",
  "log_defect",
  "archive_error",
  "refusal_access",
  "refusal_people",
  "refusal_incident",
  "refusal_plan",
  "refusal_past",
  "refusal_station",
  "refusal_form",
] as const satisfies readonly (PartName | DeferredPart)[];

/** The text in the chosen language; the English one where there is no code, as of an earlier version, or one
 * of another version or of a foreign unit. */
export function codedText(coded: TextCodeView | undefined, text: string): string {
  if (coded === undefined || coded.code === "") return text;
  const part = PARTS.find((one) => knownLabel(one, coded.code) !== undefined);
  if (part === undefined) return text;
  try {
    return knownMessage(part, coded.code, valuesOf(coded)) ?? text;
  } catch {
    return text; // a unit that is not of this version gave other parameters than the message has
  }
}

/** Texts with their codes, in their order; of an earlier version there are no codes. */
export function codedTexts(texts: readonly string[], codes: readonly TextCodeView[] = []): string[] {
  return texts.map((text, index) => codedText(codes[index], text));
}

/** Values of the placeholders; a parameter that is a coded text itself in the chosen language, too. */
function valuesOf({ texts, numbers }: TextCodeView): Record<string, string | number> {
  const own = (name: string) => !name.includes(":");
  return Object.fromEntries([
    ...Object.entries(texts)
      .filter(([name]) => own(name))
      .map(([name, text]) => {
        const code = codeWithin({ code: "", texts, numbers }, name);
        return [name, inWords(name, text, name === "fault" ? withLimits(code, texts["field"]) : code)];
      }),
    ...Object.entries(numbers)
      .filter(([name]) => own(name))
      .map(([name, value]) => [name, shown(name, value)]),
  ]);
}

function inWords(name: string, text: string, code: TextCodeView): string {
  switch (name) {
    case "tracker_reasons":
      return listed(text.split(",").map((reason) => label("tracker_reason", reason)));
    case "sensor":
      return code.code === "" ? (knownLabel("worn", text) ?? text) : codedText(code, text);
    case "field":
      return fieldLabel(text);
    default:
      return codedText(code, text);
  }
}

/** Where the innermost field with a label is named in a place of a request, such as `unit_ids.2`; -1: nowhere. */
function fieldIn(parts: readonly string[]): number {
  return parts.findLastIndex((part) => knownLabel("field_label", part) !== undefined);
}

const LIMITS = new Set(["field-not-above", "field-not-below", "field-too-high", "field-too-low"]);

/** A fault with its limit as the console writes the quantity of that field: "1 min" of `par_interval_s`. */
function withLimits(code: TextCodeView, place: string | undefined): TextCodeView {
  if (place === undefined || !LIMITS.has(code.code)) return code;
  const parts = place.split(".");
  const field = parts[fieldIn(parts)] ?? place;
  const limits = Object.entries(code.numbers).map(([name, value]) => [name, fieldValue(field, value)]);
  return { code: code.code, texts: Object.fromEntries(limits), numbers: {} };
}

/** A value in the unit that the field's name ends with. */
function fieldValue(field: string, value: number): string {
  if (field.endsWith("_ms")) return dateAndTime(value);
  if (field.endsWith("_hz")) return t("audit_value.rate", { value: written(value) });
  if (field.endsWith("_rad")) return angle((value * 180) / Math.PI);
  if (field.endsWith("_deg")) return angle(value);
  const inUnit = shown(field, value);
  return typeof inUnit === "string" ? inUnit : written(value);
}

/** The label of a field by its place in the request, and the number of an entry. */
function fieldLabel(place: string): string {
  const parts = place.split(".");
  const at = fieldIn(parts);
  if (at < 0) return place;
  const words = knownLabel("field_label", parts[at]!) ?? place;
  const entry = Number(parts[at + 1]);
  return Number.isInteger(entry) ? `${words} ${entry + 1}` : words;
}

/** The code of a parameter: "reason:" has it, "reason:away_s" a parameter of its own. */
function codeWithin({ texts, numbers }: TextCodeView, name: string): TextCodeView {
  const prefix = `${name}:`;
  const within = <V>(values: Readonly<Record<string, V>>): Record<string, V> =>
    Object.fromEntries(
      Object.entries(values)
        .filter(([one]) => one.startsWith(prefix) && one !== prefix)
        .map(([one, value]) => [one.slice(prefix.length), value]),
    );
  return { code: texts[prefix] ?? "", texts: within(texts), numbers: within(numbers) };
}

/** The text of a problem document (RFC 9457): its `detail`, in English, where its code is none or that of
 * another version; nothing where it is no such document, as a proxy may have answered. */
export function refusalText(document: unknown): string | undefined {
  const { detail, code, parameters } = (document ?? {}) as Record<string, unknown>;
  if (typeof detail !== "string") return undefined;
  const given = Object.entries(parameters ?? {});
  const texts = given.filter((one): one is [string, string] => typeof one[1] === "string");
  const numbers = given.filter((one): one is [string, number] => typeof one[1] === "number");
  const coded = { code: String(code ?? ""), texts: Object.fromEntries(texts), numbers: Object.fromEntries(numbers) };
  return codedText(coded, detail);
}

function written(value: number): string {
  return number(value, Number.isInteger(value) ? 0 : 1);
}

function angle(degrees: number): string {
  return `${number(degrees)}°`;
}

/** A number in the unit that its name ends with; others are written by the message. */
function shown(name: string, value: number): string | number {
  if (name.endsWith("_utc_s")) return dateAndTime(value * 1000);
  if (name.endsWith("_s")) return duration(value * 1000);
  if (name.endsWith("_mb")) return bytes(value * 1e6);
  if (name.endsWith("_fraction")) return percent(value);
  if (name.endsWith("_degc")) return temperature(value);
  if (name.endsWith("_m")) return length(value, 0);
  if (name.endsWith("_km")) return far(value * 1000);
  return name === "minutes" ? minutes(value * 60_000) : value;
}

/** Problems of a station or a department, each with its code where the station gives one. */
export function problemTexts(view: {
  problems: readonly string[];
  problem_codes?: readonly TextCodeView[];
}): string[] {
  return codedTexts(view.problems, view.problem_codes);
}

/** What is wrong with the station, sentence by sentence. */
export function problemsOf(health: HealthView): string[] {
  const problems = problemTexts(health);
  return health.insecure ? [...problems, t("station.not_encrypted")] : problems;
}

/** A replay of an earlier version's incident has the text alone. */
type PreflightShown = Pick<PreflightView, "level" | "text"> & Partial<PreflightView>;

/** Findings of a unit's check at its start. */
export function preflightText({ level, text, findings = [], finding_codes = [] }: PreflightShown): string {
  const found = codedTexts(findings, finding_codes);
  const joined = found.length === 0 ? text : found.join("; ");
  return t(level === "failed" ? "member.preflight_failed" : "member.preflight_warning", { text: joined });
}
