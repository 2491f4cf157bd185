/** The picture that the station describes, and how each message changes it.  Pure. */
import type {
  AlarmView,
  AnchorView,
  BeaconView,
  CommandView,
  Delta,
  ExternalMarkerView,
  HealthView,
  IncidentView,
  Message,
  PinView,
  Plan,
  ReplayView,
  Snapshot,
  Trail,
  TrailPoint,
  UnitView,
} from "../wire";
import { bounded } from "./thinning";

export interface State {
  seq: number;
  now_ms: number;
  incident: IncidentView | null;
  units: ReadonlyMap<string, UnitView>;
  alarms: ReadonlyMap<string, AlarmView>;
  commands: ReadonlyMap<string, CommandView>; // oldest first
  trails: ReadonlyMap<string, readonly TrailPoint[]>;
  pins: readonly PinView[];
  beacons: readonly BeaconView[];
  external: readonly ExternalMarkerView[]; // of other teams
  plan: Plan | null;
  anchor: AnchorView | null;
  health: HealthView;
  replay: ReplayView | null;
}

export interface Applied {
  state: State | null;
  missed: boolean; // something did not arrive: ask for a snapshot
}

// As the station thins its own trails out (base_station/core/state/trail.py).
const TRAIL_STEP_MS = 1000;
const TRAIL_STEP_M = 0.5;
const TRAIL_REST_MS = 15_000;
const TRAIL_GAP_MS = 20_000;
const RESOLVED_KEPT = 50;
const CLOSED_KEPT = 10;

/** The state after a message.  A delta that does not follow leaves the state as it was. */
export function apply(state: State | null, message: Message): Applied {
  if (message.type === "snapshot") return { state: fromSnapshot(message, state), missed: false };
  if (state === null) return { state, missed: true };
  if (message.type === "trail") return { state: withPast(state, message), missed: false };
  if (message.seq !== state.seq + 1) return { state, missed: true };
  return { state: withDelta(state, message), missed: false };
}

function fromSnapshot(message: Snapshot, before: State | null): State {
  return {
    seq: message.seq,
    now_ms: message.now_ms,
    incident: message.incident,
    units: new Map(message.units.map((unit) => [unit.unit_id, unit])),
    alarms: new Map(message.alarms.map((alarm) => [alarm.alarm_id, alarm])),
    commands: new Map(message.commands.map((command) => [command.command_id, command])),
    trails: new Map(),
    pins: message.pins,
    beacons: message.beacons,
    external: message.external,
    plan: planOf(message, before),
    anchor: message.anchor,
    health: message.health,
    replay: message.replay,
  };
}

/** The same object while it is the same plan: whoever looks at a part of it goes on looking there. */
function planOf({ plan }: Snapshot, before: State | null): Plan | null {
  const shown = before?.plan ?? null;
  return JSON.stringify(plan) === JSON.stringify(shown) ? shown : plan;
}

function withDelta(state: State, delta: Delta): State {
  return {
    ...state,
    seq: delta.seq,
    now_ms: delta.now_ms,
    incident: delta.incident ?? state.incident,
    health: delta.health ?? state.health,
    replay: delta.replay ?? state.replay,
    units: delta.units ? withUnits(state.units, delta.units) : state.units,
    trails: withTrails(state.trails, delta),
    pins: delta.pins ?? state.pins,
    beacons: delta.beacons ?? state.beacons,
    external: delta.external ?? state.external,
    alarms: delta.alarms ? withAlarms(state.alarms, delta.alarms) : state.alarms,
    commands: delta.commands ? withCommands(state.commands, delta.commands) : state.commands,
  };
}

/** What was drawn since the snapshot goes on from where the unit was before. */
function withPast(state: State, { unit_id, points }: Trail): State {
  const trail = [...points];
  for (const point of state.trails.get(unit_id) ?? []) {
    if (isStep(trail.at(-1), point)) trail.push(point);
  }
  return { ...state, trails: new Map(state.trails).set(unit_id, bounded(trail)) };
}

function withUnits(units: State["units"], changed: readonly UnitView[]): State["units"] {
  const next = new Map(units);
  for (const unit of changed) next.set(unit.unit_id, unit);
  return next;
}

/** Trails whose past was filled in come whole; the others go on to where the unit now is. */
function withTrails(trails: State["trails"], delta: Delta): State["trails"] {
  const goneOn = delta.units ? withPositions(trails, delta.units) : trails;
  return delta.trails ? new Map([...goneOn, ...Object.entries(delta.trails)]) : goneOn;
}

function withPositions(trails: State["trails"], changed: readonly UnitView[]): State["trails"] {
  let next: Map<string, readonly TrailPoint[]> | null = null;
  for (const { unit_id, position } of changed) {
    if (position === null) continue;
    const trail = trails.get(unit_id) ?? [];
    const last = trail.at(-1);
    const point: TrailPoint = [position.t_ms, position.north_m, position.east_m, position.floor];
    if (!isStep(last, point)) continue;
    if (last !== undefined && point[0] - last[0] > TRAIL_GAP_MS) point[4] = 1;
    next ??= new Map(trails);
    next.set(unit_id, bounded([...trail, point]));
  }
  return next ?? trails;
}

/** Whether a trail goes on to this point: somebody walked, came to another floor, or rested for long. */
function isStep(last: TrailPoint | undefined, point: TrailPoint): boolean {
  if (last === undefined) return true;
  const passedMs = point[0] - last[0];
  const movedM = Math.hypot(point[1] - last[1], point[2] - last[2]);
  const moved = movedM >= TRAIL_STEP_M || point[3] !== last[3];
  return passedMs >= (moved ? TRAIL_STEP_MS : TRAIL_REST_MS);
}

function withAlarms(alarms: State["alarms"], changed: readonly AlarmView[]): State["alarms"] {
  const next = new Map(alarms);
  for (const alarm of changed) next.set(alarm.alarm_id, alarm);
  const resolved = [...next.values()]
    .filter((alarm) => alarm.state === "resolved")
    .sort((a, b) => b.changed_ms - a.changed_ms);
  for (const alarm of resolved.slice(RESOLVED_KEPT)) next.delete(alarm.alarm_id);
  return next;
}

function withCommands(
  commands: State["commands"],
  changed: readonly CommandView[],
): State["commands"] {
  const next = new Map(commands);
  for (const command of changed) next.set(command.command_id, command);
  const closed = [...next.values()].filter((command) => !command.open);
  for (const command of closed.slice(0, -CLOSED_KEPT)) next.delete(command.command_id);
  return next;
}
