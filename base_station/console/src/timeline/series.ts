/** Series of a timeline, and its part of the time.  Pure. */
import type { TimelineAnswer, TimelineColumn } from "../answers";
import { duration, floorName, percent } from "../format";
import { degrees, length, number } from "../language/measures";
import { label, type PlainKey, t } from "../language/translate";

export type Timeline = TimelineAnswer;

/** Station time. */
export interface Span {
  fromMs: number;
  untilMs: number;
}

/** Limit of the station. */
export const LONGEST_MS = 24 * 3_600_000;
export const SHORTEST_MS = 10_000;

type ColumnName = {
  [Name in keyof Timeline]: Timeline[Name] extends TimelineColumn ? Name : never;
}[keyof Timeline];

export interface Strip {
  column: ColumnName;
  title: PlainKey;
  /** Values that hold until the next one: no slope between them. */
  stepped?: boolean;
  /** The scale, where it is not that of the values. */
  range?: [number, number];
  /** A value with its unit. */
  text(value: number, of: Timeline): string;
  /** The same on the axis, if that is shorter. */
  tick?(value: number, of: Timeline): string;
}

const metres = (value: number) => length(value);

export const STRIPS: readonly Strip[] = [
  {
    column: "temperature_degc",
    title: "timeline.temperature_degc",
    text: (value) => degrees(value, 1),
    tick: (value) => degrees(value),
  },
  { column: "height_m", title: "timeline.height_m", text: metres, tick: (value) => length(value, 0) },
  { column: "floor", title: "timeline.floor", stepped: true, text: floorName, tick: String },
  { column: "activity", title: "timeline.activity", stepped: true, text: activityWord },
  { column: "battery", title: "timeline.battery", range: [0, 1], text: percent },
  {
    column: "position_error_m",
    title: "timeline.position_error_m",
    text: metres,
    tick: (value) => length(value, 0),
  },
  {
    column: "silence_s",
    title: "timeline.silence_s",
    text: (value) => duration(1000 * value),
    tick: (value) => t("measure.seconds", { value: number(value) }),
  },
];

function activityWord(value: number, { activity_names }: Timeline): string {
  const name = activity_names[value] ?? "unknown";
  return label("activity", name);
}

/** The last value until then; null: none, or nothing was known then. */
export function valueAt({ t_ms, values }: TimelineColumn, atMs: number): number | null {
  let [low, high] = [0, t_ms.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (t_ms[middle]! <= atMs) low = middle + 1;
    else high = middle;
  }
  return low === 0 ? null : (values[low - 1] ?? null);
}

/** A column in words, for screen readers: "20.1 °C to 180.0 °C"; null: it is empty. */
export function extremes(strip: Strip, of: Timeline): string | null {
  const known = of[strip.column].values.filter((value) => value !== null);
  if (known.length === 0) return null;
  const [least, greatest] = [known.reduce((a, b) => Math.min(a, b)), known.reduce((a, b) => Math.max(a, b))];
  const [low, high] = [strip.text(least, of), strip.text(greatest, of)];
  return low === high ? low : t("timeline.range", { low, high });
}

/** The last part, at most as long as the station allows. */
export function bounded({ fromMs, untilMs }: Span): Span {
  return { fromMs: Math.max(fromMs, untilMs - LONGEST_MS), untilMs };
}

/** A part of the whole, of `factor` times the length, about its middle. */
export function zoomed(shown: Span, factor: number, whole: Span): Span {
  const middle = (shown.fromMs + shown.untilMs) / 2;
  const half = (factor * (shown.untilMs - shown.fromMs)) / 2;
  return within({ fromMs: middle - half, untilMs: middle + half }, whole);
}

/** The part beside it: before (-1) or after (1), by half of its length. */
export function moved(shown: Span, direction: -1 | 1, whole: Span): Span {
  const byMs = (direction * (shown.untilMs - shown.fromMs)) / 2;
  return within({ fromMs: shown.fromMs + byMs, untilMs: shown.untilMs + byMs }, whole);
}

/** As long, where that is in the whole; neither longer than it nor too short to show anything. */
export function within(part: Span, whole: Span): Span {
  const wholeMs = whole.untilMs - whole.fromMs;
  const lengthMs = Math.min(Math.max(part.untilMs - part.fromMs, SHORTEST_MS), wholeMs);
  const fromMs = Math.min(Math.max(part.fromMs, whole.fromMs), whole.untilMs - lengthMs);
  return { fromMs: Math.round(fromMs), untilMs: Math.round(fromMs + lengthMs) };
}
