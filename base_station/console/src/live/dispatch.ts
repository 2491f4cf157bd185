/** Reports of the dispatch centre in words.  Pure. */
import type { CallSignAnswer } from "../answers";
import type { DispatchView, IncidentView } from "../wire";
import { dateAndTime, zone } from "../format";
import { listed } from "../language/measures";
import { t } from "../language/translate";

const NAME_CHARACTERS = 80; // of an incident

/** Those from which an incident may be opened: neither dismissed nor over. */
export function offered(dispatches: readonly DispatchView[]): DispatchView[] {
  return dispatches.filter((one) => !one.is_dismissed && !one.has_ended);
}

/** The dispatch of that number: of the incident, or of those that have opened none. */
export function dispatchOf(
  number: string,
  incident: IncidentView | null,
  dispatches: readonly DispatchView[],
): DispatchView | null {
  const known = [incident?.dispatch ?? null, ...dispatches];
  return known.find((one) => one?.number === number) ?? null;
}

/** "Structure fire, Main St 5, E12, L4". */
export function summary(dispatch: DispatchView): string {
  const kind = dispatch.type || dispatch.type_code;
  const words = [kind, dispatch.address, ...dispatch.units].filter((word) => word !== "");
  return words.length === 0 ? t("dispatch.nothing_known") : listed(words);
}

/** Name of the incident, for a person to change. */
export function suggestedName(dispatch: DispatchView): string {
  const words = [dispatch.type, dispatch.address].filter((word) => word !== "").join(", ");
  return (words || t("dispatch.title", { number: dispatch.number })).slice(0, NAME_CHARACTERS).trim();
}

/** What is known of it, for a list of names and values. */
export function facts(dispatch: DispatchView): [name: string, value: string][] {
  const { type, type_code: code } = dispatch;
  const kind = type !== "" && code !== "" && code !== type ? `${type} (${code})` : type || code;
  const all: [string, string][] = [
    [t("dispatch.type"), kind],
    [t("dispatch.priority"), dispatch.priority],
    [t("dispatch.address"), dispatch.address],
    [t("dispatch.position"), positionWords(dispatch)],
    [t("dispatch.call"), time(dispatch.called_ms)],
    [t("dispatch.dispatched"), time(dispatch.dispatched_ms)],
    [t("dispatch.changed"), time(dispatch.updated_ms)],
    [t("dispatch.remarks"), dispatch.remarks],
    [t("dispatch.state"), dispatch.has_ended ? t("dispatch.ended") : ""],
  ];
  return all.filter(([, value]) => value !== "");
}

export function positionWords({ lat_deg, lon_deg }: DispatchView): string {
  return lat_deg === null || lon_deg === null ? "" : `${lat_deg.toFixed(6)}, ${lon_deg.toFixed(6)}`;
}

/** "Engine 12 (E12): crew Engine 12", and units that are unknown at this station. */
export function unitWords(one: CallSignAnswer): string {
  const name = one.words === one.call_sign ? one.words : `${one.words} (${one.call_sign})`;
  const known = [one.crew === "" ? "" : t("dispatch.crew", { crew: one.crew }), ...one.unit_ids].filter((word) => word !== "");
  return known.length === 0
    ? t("dispatch.unit_unknown", { unit: name })
    : t("dispatch.unit_known", { unit: name, known: listed(known) });
}

function time(ms: number | null): string {
  return ms === null ? "" : `${dateAndTime(ms)} ${zone(ms)}`;
}
