/** The picture that the station describes, and how each message changes it.  Pure. */
import type {
  AlarmView,
  AnchorView,
  BeaconView,
  FieldDelta,
  CommandView,
  DispatchView,
  ExternalMarkerView,
  HealthView,
  IncidentView,
  Message,
  PinView,
  Plan,
  ReplayView,
  SiteView,
  Snapshot,
  Trail,
  TrailPoint,
  UnitChange,
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
  dispatches: readonly DispatchView[]; // from which no incident was opened
  plan: Plan | null; // of `incident`, as the anchor is
  anchor: AnchorView | null;
  incidents: readonly IncidentView[]; // open, and closed ones whose people are still on their ground
  sites: readonly SiteView[]; // other grounds than that of `incident`
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

/** The state after a message.  FieldDelta that do not follow leave the state as it was. */
export function apply(state: State | null, message: Message): Applied {
  if (message.type === "snapshot") return { state: fromSnapshot(message, state), missed: false };
  if (state === null) return { state, missed: true };
  if (message.type === "trail") return { state: withPast(state, message), missed: false };
  if (message.after_seq !== state.seq) return { state, missed: true };
  return { state: withChanges(state, message), missed: false };
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
    dispatches: message.dispatches,
    plan: knownPlan(message.plan, before),
    anchor: message.anchor,
    incidents: message.incidents,
    sites: message.sites.map((site) => ({ ...site, plan: knownPlan(site.plan, before) })),
    health: message.health,
    replay: message.replay,
  };
}

/** The same object while the plan is the same, so that the visible part of it is kept. */
function knownPlan(plan: Plan | null, before: State | null): Plan | null {
  if (plan === null || before === null) return plan;
  const text = JSON.stringify(plan);
  const known = [before.plan, ...before.sites.map((site) => site.plan)];
  return known.find((one) => JSON.stringify(one) === text) ?? plan;
}

/** The changed units, whole. */
function unitsOf(state: State, { units }: FieldDelta): UnitView[] {
  return Object.entries(units ?? {}).map(([unitId, change]) =>
    changedUnit(state.units.get(unitId), change),
  );
}

/** Of an object those fields change that the change has, and so on in objects in it; a list is replaced. */
function changedUnit(unit: UnitView | undefined, change: UnitChange): UnitView {
  return merged(unit, change) as UnitView;
}

function merged(before: unknown, change: unknown): unknown {
  if (!isRecord(change) || !isRecord(before)) return change;
  const next: Record<string, unknown> = { ...before };
  for (const name in change) next[name] = merged(before[name], change[name]);
  return next;
}

function isRecord(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

function withChanges(state: State, changes: FieldDelta): State {
  const units = unitsOf(state, changes);
  return {
    ...state,
    seq: changes.seq,
    now_ms: changes.now_ms,
    incident: changes.incident ?? state.incident,
    health: changes.health ?? state.health,
    replay: changes.replay ?? state.replay,
    units: units.length > 0 ? withUnits(state.units, units) : state.units,
    trails: withTrails(state.trails, changes, units),
    pins: changes.pins ?? state.pins,
    beacons: changes.beacons ?? state.beacons,
    external: changes.external ?? state.external,
    alarms: changes.alarms ? withAlarms(state.alarms, changes.alarms) : state.alarms,
    commands: changes.commands ? withCommands(state.commands, changes.commands) : state.commands,
  };
}

/** The trail since the snapshot continues from the previous position of the unit. */
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

/** Trails whose past was filled in come completely; all continue to the current position of the unit. */
function withTrails(
  trails: State["trails"],
  changes: FieldDelta,
  units: readonly UnitView[],
): State["trails"] {
  const filled = changes.trails ? new Map([...trails, ...Object.entries(changes.trails)]) : trails;
  return withPositions(filled, units, changes.passed ?? {});
}

function withPositions(
  trails: State["trails"],
  changed: readonly UnitView[],
  passed: Record<string, TrailPoint[]>,
): State["trails"] {
  let next: Map<string, readonly TrailPoint[]> | null = null;
  for (const { unit_id, position } of changed) {
    if (position === null) continue;
    const now: TrailPoint = [position.t_ms, position.north_m, position.east_m, position.floor];
    const before = trails.get(unit_id) ?? [];
    let trail = before;
    for (const point of [...(passed[unit_id] ?? []), now]) trail = goneOn(trail, point);
    if (trail === before) continue;
    next ??= new Map(trails);
    next.set(unit_id, bounded(trail));
  }
  return next ?? trails;
}

/** The same trail where this point is none of it. */
function goneOn(trail: readonly TrailPoint[], point: TrailPoint): readonly TrailPoint[] {
  const last = trail.at(-1);
  if (!isStep(last, point)) return trail;
  const isAfterGap = last !== undefined && point[0] - last[0] > TRAIL_GAP_MS;
  const [t_ms, north_m, east_m, floor] = point;
  return [...trail, isAfterGap ? [t_ms, north_m, east_m, floor, 1] : point];
}

/** Whether a trail is extended to this point: after a distance, a change of the floor, or a long rest. */
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
