/** The reason of an alarm in words: the threshold that was crossed, by what, and when. */
import type { AlarmExplanationAnswer } from "../answers";
import { clockTime } from "../format";

const SERIES: Record<string, string> = {
  motionless_s: "time without motion",
  temperature_degc: "temperature",
  battery: "battery",
};

/** Null: the rule judges no series of values. */
export function crossingText({ crossing }: AlarmExplanationAnswer): string | null {
  if (crossing === null) return null;
  const { series, threshold, limit, t_ms, value } = crossing;
  return (
    `At ${clockTime(t_ms)} ${SERIES[series] ?? series} was ${quantity(value, series)}, ` +
    `beyond the threshold "${name(threshold)}" (${quantity(limit, series)}).`
  );
}

/** Those of the rule at that time, as "pre-alert 20 s, alarm 30 s". */
export function thresholdsText({ thresholds }: AlarmExplanationAnswer): string {
  return Object.entries(thresholds)
    .map(([threshold, limit]) => `${name(threshold)} ${quantity(limit, threshold)}`)
    .join(", ");
}

/** A threshold without the unit at its end. */
function name(threshold: string): string {
  return threshold.replace(/_(s|degc|m|mps|ms)$/, "").replaceAll("_", " ");
}

/** Its unit is at the end of the name of what it is of. */
function quantity(value: number, of: string): string {
  if (of === "battery" || of === "low") return `${Math.round(100 * value)} %`;
  const rounded = String(Math.round(10 * value) / 10);
  const unit = { s: " s", degc: " °C", m: " m", mps: " m/s", ms: " ms" }[of.split("_").at(-1) ?? ""];
  return rounded + (unit ?? "");
}
