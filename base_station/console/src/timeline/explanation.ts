/** The reason of an alarm in words: the threshold that was crossed, by what, and when. */
import type { AlarmExplanationAnswer } from "../answers";
import { clockTime } from "../format";
import { degrees, length, listed, number, share, speed } from "../language/measures";
import { knownLabel, t } from "../language/translate";

/** Null: the rule judges no series of values. */
export function crossingText({ crossing }: AlarmExplanationAnswer): string | null {
  if (crossing === null) return null;
  const { series, threshold, limit, t_ms, value } = crossing;
  return t("crossing.sentence", {
    time: clockTime(t_ms),
    series: knownLabel("crossing", series) ?? series,
    value: quantity(value, series),
    threshold: name(threshold),
    limit: quantity(limit, series),
  });
}

/** Those of the rule at that time, as "pre-alert 20 s, alarm 30 s". */
export function thresholdsText({ thresholds }: AlarmExplanationAnswer): string {
  const each = Object.entries(thresholds).map(([threshold, limit]) =>
    t("crossing.threshold", { name: name(threshold), value: quantity(limit, threshold) }),
  );
  return listed(each);
}

/** A threshold without the unit at its end. */
function name(threshold: string): string {
  return threshold.replace(/_(s|degc|m|mps|ms)$/, "").replaceAll("_", " ");
}

/** Its unit is at the end of the name of what it is of. */
function quantity(value: number, of: string): string {
  if (of === "battery" || of === "low") return share(value);
  const digits = Number.isInteger(Math.round(10 * value) / 10) ? 0 : 1;
  switch (of.split("_").at(-1)) {
    case "s":
      return t("measure.seconds", { value: number(value, digits) });
    case "degc":
      return degrees(value, digits);
    case "m":
      return length(value, digits);
    case "mps":
      return speed(value, digits);
    case "ms":
      return t("measure.milliseconds", { value: number(value, digits) });
    default:
      return number(value, digits);
  }
}
