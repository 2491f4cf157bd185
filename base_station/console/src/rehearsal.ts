/** A rehearsal of alarm thresholds: what is asked of the station, and its figures as words.  Pure. */
import type { EpisodeChange, LevelFigures, RehearsalAnswer, ThresholdAnswer } from "./answers";
import { clockTime, ruleWord } from "./format";
import { number } from "./language/measures";
import type { DeferredTexts } from "./language/catalogue";
import { knownLabel, knownMessage, t } from "./language/translate";

type Text = keyof DeferredTexts["rehearsal"];

/** The texts of this dialog come after the page. */
export function text(key: Text, values: Record<string, string | number> = {}): string {
  return knownMessage("rehearsal", key, values) ?? "";
}

export function thresholdLabel(threshold: string): string {
  return knownLabel("rehearsal", threshold) ?? threshold.replaceAll("_", " ");
}

/** Fields of the form: one for each threshold of the rule by its name, and those of the sweep. */
export type Fields = Readonly<Record<string, string>>;
export const SWEPT = "swept";
export const UNTIL = "until";
export const STEP = "step";

export interface Wanted {
  changes: readonly string[];
  sweep: string; // empty: none
}

/** Null: nothing is changed. */
export function wantedOf(thresholds: readonly ThresholdAnswer[], fields: Fields): Wanted | null {
  const swept = fields[SWEPT] ?? "";
  const changes = thresholds
    .filter((one) => one.threshold !== swept && Number(fields[one.threshold]) !== one.value)
    .map((one) => `${one.rule}.${one.threshold}=${fields[one.threshold] ?? ""}`);
  const range = thresholds.find((one) => one.threshold === swept);
  if (range === undefined) return changes.length === 0 ? null : { changes, sweep: "" };
  const values = [fields[swept], fields[UNTIL], fields[STEP]].join(":");
  return { changes, sweep: `${range.rule}.${swept}=${values}` };
}

export function levelLabel({ rule, level }: Pick<LevelFigures, "rule" | "level">): string {
  return knownLabel("alarm_label", `${rule}/${level}`) ?? ruleWord(rule);
}

/** Value of the swept threshold, or the sentence for one set of thresholds. */
export function pointLabel({ swept }: RehearsalAnswer, thresholds: Readonly<Record<string, number>>): string {
  return Object.entries(thresholds)
    .filter(([name]) => swept === "" || name === swept)
    .map(([, value]) => plain(value))
    .join(", ");
}

/** Points that have figures. */
export function possible({ points }: RehearsalAnswer): RehearsalAnswer["points"] {
  return points.filter(({ problem }) => problem === "");
}

export const COUNTS = ["same", "earlier", "later", "missed", "added"] as const;

export function rate(perHour: number | null): string {
  return perHour === null ? "" : number(perHour, 2);
}

export function shift(seconds: number | null): string {
  if (seconds === null) return "";
  const size = t("measure.seconds", { value: number(Math.abs(seconds), 1) });
  return seconds > 0 ? `+${size}` : seconds < 0 ? `−${size}` : size;
}

export function person(change: EpisodeChange, { wearers }: RehearsalAnswer): string {
  const names = wearers[change.unit_id] ?? [];
  return names.length === 0 ? change.unit_id : `${names.join(", ")} (${change.unit_id})`;
}

export function raisedAt(ms: number | null): string {
  return ms === null ? text("not_raised") : clockTime(ms);
}

function plain(value: number): string {
  return number(value, Number.isInteger(value) ? 0 : 2);
}

export interface Line {
  points: string; // of an SVG polyline within 100 x 40, y downwards
  thenY: number | null; // of the dashed line
}

export const CHART_WIDTH = 100;
export const CHART_HEIGHT = 40;

/** Alarms per hour of wear over the values of a sweep; null: fewer than two values, or nobody wore a unit. */
export function chartLine(levels: readonly LevelFigures[]): Line | null {
  const rates = levels.map((one) => one.rehearsed_per_hour);
  if (levels.length < 2 || rates.includes(null)) return null;
  const then = levels[0]?.recorded_per_hour ?? null;
  const top = Math.max(...rates.map((one) => one ?? 0), then ?? 0, Number.MIN_VALUE);
  const y = (perHour: number) => CHART_HEIGHT * (1 - perHour / top);
  const x = (place: number) => (CHART_WIDTH * place) / (levels.length - 1);
  return {
    points: rates.map((one, place) => `${x(place).toFixed(1)},${y(one ?? 0).toFixed(1)}`).join(" "),
    thenY: then === null ? null : y(then),
  };
}
