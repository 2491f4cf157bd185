/** Numbers, dates and quantities by `Intl`, in the chosen language and units. */
import { computed, signal } from "@preact/signals";
import { shown } from "./catalogue";

export const UNITS = ["metric", "imperial"] as const;
export type Units = (typeof UNITS)[number];
export const units = signal<Units>("metric");

/** European: the floor at the ground is not counted.  American: it is the first. */
export const FLOOR_NAMES = ["european", "american"] as const;
export type FloorNames = (typeof FLOOR_NAMES)[number];
export const floorNames = signal<FloorNames>("european");

const tag = computed(() => regional(shown.value.language));

/** The language as the browser's person writes it: `en-GB` where they read English of Britain. */
export function locale(): string {
  return tag.value;
}

function regional(language: string): string {
  const all = typeof navigator === "undefined" ? [] : (navigator.languages ?? []);
  return all.find((one) => one.split("-")[0] === language) ?? language;
}

const made = new Map<string, unknown>();

/** An `Intl` object is slow to make: each is kept. */
function kept<T, O>(Kind: new (locale: string, options: O) => T, options: O): T {
  const name = `${Kind.name} ${locale()} ${JSON.stringify(options)}`;
  const format = (made.get(name) as T | undefined) ?? new Kind(locale(), options);
  made.set(name, format);
  return format;
}

/** "1,234.5"; `digits` behind the point, all of them written. */
export function number(value: number, digits = 0, leastWhole = 1): string {
  const format = kept(Intl.NumberFormat, {
    minimumFractionDigits: digits,
    maximumFractionDigits: digits,
    minimumIntegerDigits: leastWhole,
  });
  return format.format(value);
}

/** A number and its unit (of `Intl`: "meter", "percent"), on one line. */
export function quantity(
  value: number,
  unit: string,
  digits = 0,
  unitDisplay: "short" | "narrow" = "short",
): string {
  const format = kept(Intl.NumberFormat, {
    style: "unit",
    unit,
    unitDisplay,
    minimumFractionDigits: digits,
    maximumFractionDigits: digits,
  });
  const parts = format.formatToParts(value).filter(({ type }) => type !== "literal");
  const [figure, sign] = [parts.filter(({ type }) => !isUnit(type)), parts.filter(({ type }) => isUnit(type))];
  return `${figure.map((part) => part.value).join("")}\u00a0${sign.map((part) => part.value).join("")}`;
}

function isUnit(type: string): boolean {
  return type === "unit" || type === "percentSign";
}

const METRES_PER_FOOT = 0.3048;

/** "2.1 m", or "7 ft". */
export function length(metres: number, digits = 1): string {
  if (units.value === "imperial") return quantity(metres / METRES_PER_FOOT, "foot");
  return quantity(metres, "meter", digits);
}

const METRES_PER_MILE = 1609.344;

/** Of what is kilometres or miles away. */
export function far(metres: number): string {
  return units.value === "imperial"
    ? quantity(metres / METRES_PER_MILE, "mile")
    : quantity(metres / 1000, "kilometer");
}

/** "m" or "ft", for the field in which a length is written. */
export function lengthUnit(): string {
  return length(0).split("\u00a0")[1] ?? "";
}

/** A length as it is written in a field, and back. */
export function shownLength(metres: number): number {
  return units.value === "imperial" ? metres / METRES_PER_FOOT : metres;
}

/** The same, no finer than a person would write it. */
export function lengthField(metres: number): string {
  return String(Number(shownLength(metres).toFixed(2)));
}

export function metresOf(written: number): number {
  return units.value === "imperial" ? written * METRES_PER_FOOT : written;
}

/** "1.4 m/s", or "4.6 ft/s". */
export function speed(metresPerSecond: number, digits = 1): string {
  return units.value === "imperial"
    ? quantity(metresPerSecond / METRES_PER_FOOT, "foot-per-second", digits)
    : quantity(metresPerSecond, "meter-per-second", digits);
}

/** "119 °C", or "246 °F". */
export function degrees(celsius: number, digits = 0): string {
  return units.value === "imperial"
    ? quantity(32 + 1.8 * celsius, "fahrenheit", digits)
    : quantity(celsius, "celsius", digits);
}

/** Of a part of one: "65 %". */
export function share(part: number): string {
  return quantity(100 * part, "percent");
}

/** Time of the day where the console stands. */
export function clock(ms: number, withSeconds = true): string {
  const seconds = withSeconds ? ({ second: "2-digit" } as const) : {};
  return kept(Intl.DateTimeFormat, {
    hour: "2-digit",
    minute: "2-digit",
    ...seconds,
    hourCycle: "h23",
  } as const).format(ms);
}

/** "Nov 26, 2026", "26.11.2026": months by name or day before month is what the locale says. */
export function date(ms: number): string {
  return kept(Intl.DateTimeFormat, { dateStyle: "medium" } as const).format(ms);
}

let collator = new Intl.Collator(); // kept apart from the others: lists are sorted with every message
let collatorOf = "";

/** Order of two names in the language shown; numbers by value, so that Ladder 2 is before Ladder 10. */
export function compareNames(one: string, other: string): number {
  if (collatorOf !== locale()) {
    collatorOf = locale();
    collator = new Intl.Collator(collatorOf, { numeric: true });
  }
  return collator.compare(one, other);
}

/** Beside one another, not as a sentence: `Intl.ListFormat` puts a word before the last in some languages. */
export function listed(words: readonly string[]): string {
  return words.join(", ");
}
