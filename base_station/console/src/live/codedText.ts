/** Texts by the codes and parameters of the station.  Pure. */
import { bytes, dateAndTime, duration, minutes, percent } from "../format";
import type { PartName } from "../language/catalogue";
import { knownMessage, t } from "../language/translate";
import type { HealthView, TextCodeView } from "../wire";

/** The text in the chosen language; the station's English one where there is no code, as of an earlier
 * version, or one of another version. */
export function codedText(part: PartName, coded: TextCodeView | undefined, text: string): string {
  if (coded === undefined || coded.code === "") return text;
  const numbers = Object.entries(coded.numbers).map(([name, value]) => [name, shown(name, value)]);
  return knownMessage(part, coded.code, { ...coded.texts, ...Object.fromEntries(numbers) }) ?? text;
}

/** A number in the unit that its name ends with; others are written by the message. */
function shown(name: string, value: number): string | number {
  if (name.endsWith("_utc_s")) return dateAndTime(value * 1000);
  if (name.endsWith("_s")) return duration(value * 1000);
  if (name.endsWith("_mb")) return bytes(value * 1e6);
  if (name.endsWith("_fraction")) return percent(value);
  return name === "minutes" ? minutes(value * 60_000) : value;
}

/** Problems of a station or a department, each with its code where the station gives one. */
export function problemTexts(view: {
  problems: readonly string[];
  problem_codes?: readonly TextCodeView[];
}): string[] {
  return view.problems.map((text, index) => codedText("problem", view.problem_codes?.[index], text));
}

/** What is wrong with the station, sentence by sentence. */
export function problemsOf(health: HealthView): string[] {
  const problems = problemTexts(health);
  return health.insecure ? [...problems, t("station.not_encrypted")] : problems;
}
