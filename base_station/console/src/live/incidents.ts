/** Several incidents on one station: which is shown, and the picture cut to it.  Pure. */
import type { AlarmView, IncidentView, UnitView } from "../wire";
import { isOpen } from "./alarms";
import type { State } from "./state";

/** An open incident that can be shown. */
export interface IncidentChoice {
  incident: IncidentView;
  openAlarms: number; // of its members
}

/** The open incidents in the order of opening; empty while there is nothing to choose. */
export function choicesOf(state: State): IncidentChoice[] {
  const open = openIncidents(state);
  if (open.length < 2) return [];
  const alarms = [...state.alarms.values()].filter(isOpen);
  return open.map((incident) => ({
    incident,
    openAlarms: alarms.filter((alarm) => isOf(alarm, incident, state)).length,
  }));
}

function openIncidents({ incidents }: State): IncidentView[] {
  return incidents.filter((one) => one.closed_ms === null);
}

function isOf(alarm: AlarmView, { incident_id }: IncidentView, { units }: State): boolean {
  return units.get(alarm.unit_id)?.incident_id === incident_id;
}

/** Of several open incidents the first of `wanted` that is open; else the one that the station names.  A
 * newly opened one does not replace the shown one. */
export function shownIncident(
  state: State,
  wanted: readonly (string | null)[],
): IncidentView | null {
  const open = openIncidents(state);
  if (open.length < 2) return state.incident;
  const found = wanted.map((id) => open.find((one) => one.incident_id === id));
  return found.find((one) => one !== undefined) ?? state.incident;
}

/** State reduced to the site and the people of one incident.  Alarms stay those of all.  Unchanged while
 * the station has one site. */
export function cutTo(state: State, incident: IncidentView | null): State {
  if (incident === null || state.sites.length === 0) return state;
  const units = entriesWhere(state.units, (unit) => unit.incident_id === incident.incident_id);
  const isHere = (one: { site_id: string }) => one.site_id === incident.site_id;
  const ground = state.incident?.site_id === incident.site_id ? state : state.sites.find(isHere);
  return {
    ...state,
    incident,
    units,
    plan: ground?.plan ?? null,
    anchor: ground?.anchor ?? null,
    commands: entriesWhere(
      state.commands,
      (command) =>
        command.incident_id === incident.incident_id ||
        command.units.some(({ unit_id }) => units.has(unit_id)),
    ),
    trails: entriesWhere(state.trails, (_, unitId) => units.has(unitId)),
    pins: onlyThose(state.pins, (pin) => units.has(pin.unit_id)),
    beacons: onlyThose(state.beacons, isHere),
    external: onlyThose(state.external, isHere),
  };
}

/** A value that is no such list is kept: it is reported where it is shown, and affects nothing else. */
function onlyThose<T>(all: readonly T[], isWanted: (one: T) => boolean): readonly T[] {
  try {
    return all.filter(isWanted);
  } catch {
    return all;
  }
}

function entriesWhere<V>(
  all: ReadonlyMap<string, V>,
  isWanted: (value: V, key: string) => boolean,
): ReadonlyMap<string, V> {
  return new Map([...all].filter(([key, value]) => isWanted(value, key)));
}

/** Units that the cut picture leaves out, and that no open incident has. */
export function unassignedUnits(state: State, shown: State): UnitView[] {
  if (shown.units === state.units) return [];
  const open = new Set<string | null>(openIncidents(state).map((one) => one.incident_id));
  return [...state.units.values()].filter(
    (unit) => !shown.units.has(unit.unit_id) && !open.has(unit.incident_id),
  );
}
