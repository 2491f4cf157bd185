/** Things as the station sends them, with what a test cares about changed. */
import type {
  AlarmView,
  FieldDelta,
  CommandView,
  DispatchView,
  DeliveryState,
  ExternalMarkerView,
  HealthView,
  PositionView,
  Snapshot,
  StatusView,
  UnitView,
} from "../src/wire";

export const HEALTH: HealthView = {
  problems: [],
  problem_codes: [],
  messages: 0,
  undecodable: 0,
  unknown_units: 0,
  log_bytes: 0,
  disk_free_bytes: 0,
  messages_per_s: 0,
  insecure: false,
  standby: null,
  recordings: [],
  repeated: 0,
  left_out: 0,
  missing: 0,
  forwarders: [],
  radio: [],
  archive: null,
  reading: null,
};

export const STATUS: StatusView = {
  activity: "walking",
  motionless_s: 0,
  battery: 0.8,
  mayday: false,
  steps: 0,
  distance_m: 0,
  battery_left_s: null,
  battery_state: "unknown",
  electronics: [],
  posture: "unknown",
  posture_confidence: 0,
  mobility: "unknown",
};

export function position(change: Partial<PositionView> = {}): PositionView {
  return {
    t_ms: 1_000,
    north_m: 0,
    east_m: 0,
    down_m: 0,
    floor: 0,
    ellipse_major_m: 2,
    ellipse_minor_m: 1,
    ellipse_heading_rad: 0,
    std_down_m: 0.5,
    heading_rad: 0,
    heading_std_rad: 0.1,
    quality: "good",
    quality_reason: "",
    since_gps_s: null,
    lat_deg: null,
    lon_deg: null,
    floor_probability: null,
    reach: [],
    floor_down_m: null,
    ...change,
  };
}

export function unit(unitId: string, change: Partial<UnitView> = {}): UnitView {
  return {
    unit_id: unitId,
    label: unitId,
    registered: true,
    person: null,
    link: "live",
    last_heard_ms: 1_000,
    status: STATUS,
    status_ms: 1_000,
    ambient_degc: 20,
    heat_level: "",
    heat_used: 0,
    position: null,
    inside_since_ms: null,
    duty: null,
    trust: { level: "green", reason: "", reason_codes: [] },
    alarms: [],
    clock: null,
    cloned: false,
    gps: null,
    switched_off: false,
    ambient_ms: 1_000,
    ambient_sensors: [],
    can_be_notified: true,
    preflight: { level: "ok", text: "", findings: [], finding_codes: [] },
    tracker: "eskf",
    sensors: [{ name: "", place: "foot", place_recognised: false, mount: "", model: "" }],
    incident_id: "i1",
    ...change,
  };
}

export function alarm(alarmId: string, change: Partial<AlarmView> = {}): AlarmView {
  return {
    alarm_id: alarmId,
    rule: "no_motion",
    unit_id: "a",
    priority: 1,
    state: "raised",
    level: "alarm",
    text: "No motion",
    by: "",
    raised_ms: 0,
    last_raised_ms: 0,
    changed_ms: 0,
    code: "",
    parameters: {},
    reason: "",
    note: "",
    peak: null,
    ...change,
  };
}

/** A command to these units, and how far it has got with each. */
export function command(
  commandId: string,
  units: Record<string, DeliveryState>,
  change: Partial<CommandView> = {},
): CommandView {
  return {
    command_id: commandId,
    kind: "evacuate",
    text: "",
    issued_by: "chief",
    issued_ms: 0,
    expires_ms: 60_000,
    asks_wearer: true,
    notifies_wearer: true,
    open: true,
    units: Object.entries(units).map(([unit_id, state]) => ({
      unit_id,
      state,
      sent_ms: null,
      received_ms: null,
      notified_ms: null,
      acknowledged_ms: null,
      acknowledged_by: "",
      reason: "",
      acknowledged_via: "",
      can_be_notified: true,
      repeated_ms: null,
      ended_ms: null,
      signal: "",
      reason_code: null,
    })),
    incident_id: "",
    ended_ms: null,
    ended_command_id: "",
    ...change,
  };
}

export function dispatch(number: string, change: Partial<DispatchView> = {}): DispatchView {
  return {
    number,
    source: "json",
    type: "Structure fire",
    type_code: "69D6",
    priority: "",
    address: "Main St 5",
    lat_deg: 52.5,
    lon_deg: 13.4,
    units: ["E12", "L4"],
    called_ms: null,
    dispatched_ms: null,
    updated_ms: null,
    remarks: "",
    has_ended: false,
    warnings: [],
    received_ms: 0,
    is_dismissed: false,
    warning_codes: [],
    ...change,
  };
}

export function snapshot(change: Partial<Snapshot> = {}): Snapshot {
  return {
    type: "snapshot",
    seq: 10,
    now_ms: 1_000,
    incident: null,
    units: [],
    alarms: [],
    commands: [],
    pins: [],
    beacons: [],
    external: [],
    plan: null,
    anchor: null,
    health: HEALTH,
    replay: null,
    incidents: [],
    sites: [],
    plan_placed: true,
    dispatches: [],
    ...change,
  };
}

/** What changed since the message before; units are whole. */
export function delta(
  seq: number,
  { units = [], ...change }: Partial<Omit<FieldDelta, "units">> & { units?: UnitView[] } = {},
): FieldDelta {
  const byId = Object.fromEntries(units.map((one) => [one.unit_id, one]));
  return { type: "field_delta", seq, after_seq: seq - 1, now_ms: 2_000, units: byId, ...change };
}

export function externalMarker(change: Partial<ExternalMarkerView> = {}): ExternalMarkerView {
  return {
    marker_id: "county/police-1",
    source: "county",
    name: "Police 1",
    kind: "person",
    remarks: "",
    north_m: 1,
    east_m: 2,
    radius_m: null,
    t_ms: 1_000,
    stale_ms: 60_000,
    site_id: "",
    ...change,
  };
}
