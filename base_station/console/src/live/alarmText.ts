/** Sentences and short names of alarms, by the code and the parameters of the station.  Pure. */
import type { AlarmParametersView } from "../answers";
import { duration, minutes, percent, temperature } from "../format";
import { date, length, listed } from "../language/measures";
import { knownMessage, label, t } from "../language/translate";
import { codedText } from "./codedText";

export interface AlarmSentence {
  code: string;
  parameters: AlarmParametersView;
  text: string; // in English, of the station
}

/** The sentence in the chosen language; the station's own one where the code is of another version, or
 * there is none as in logs of earlier versions. */
export function alarmText({ code, parameters, text }: AlarmSentence): string {
  return knownMessage("alarm_text", code, valuesOf(code, parameters)) ?? text;
}

function valuesOf(code: string, given: AlarmParametersView): Record<string, string> {
  const written = <V>(value: V | null | undefined, inWords: (value: V) => string) =>
    value === null || value === undefined ? "" : inWords(value);
  return {
    who: subjectOf(given),
    unit_id: given.unit_id ?? "",
    duration: written(given.duration_s, (s) => duration(s * 1000)),
    minutes: written(given.duration_s, (s) => minutes(s * 1000)),
    temperature: written(given.temperature_degc, temperature),
    heat: written(given.heat_fraction, percent),
    battery: written(given.battery_fraction, percent),
    radius: written(given.radius_m, (m) => length(m, 0)),
    reasons: reasonsOf(code, given.reasons ?? []),
    fault: faultOf(given),
    calibrated: written(given.calibrated_s, (s) => date(s * 1000)),
  };
}

function subjectOf({ member, member_before: before }: AlarmParametersView): string {
  const name = member ?? "";
  return before === null || before === undefined ? name : t("alarm_subject.either", { member: name, before });
}

/** By its code; foreign units and those of earlier versions report sentences alone. */
function faultOf(given: AlarmParametersView): string {
  const { fault, fault_code, fault_texts: texts, fault_numbers: numbers } = given;
  const coded = { code: fault_code ?? "", texts: texts ?? {}, numbers: numbers ?? {} };
  return codedText(coded, fault ?? "");
}

function reasonsOf(code: string, reasons: readonly string[]): string {
  const part = code === "gps-unused" ? "fix_fault" : "tracker_reason";
  return listed((reasons.length === 0 ? ["none"] : reasons).map((reason) => label(part, reason)));
}
