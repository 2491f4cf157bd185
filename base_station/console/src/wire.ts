/** Messages of the station to the console, over the WebSocket.
 *
 * Generated from `base_station/views/wire`, which describes every field; after a change there run
 * `python -m tests.rig.console_types`.
 */
import type { Plan } from "./plan/planFile";

export type { Plan };

export interface TextCodeView {
  code: string;
  texts: Record<string, string>;
  numbers: Record<string, number>;
}

export interface PersonView {
  person_id: string;
  name: string;
  crew: string;
  role: string;
  photo_url: string | null;
}

export interface SensorTemperatureView {
  name: string;
  temperature_degc: number;
}

export interface StatusView {
  activity: string;
  motionless_s: number;
  battery: number | null;
  mayday: boolean;
  steps: number;
  distance_m: number;
  battery_left_s: number | null;
  battery_state: string;
  electronics: SensorTemperatureView[];
  posture: string;
  posture_confidence: number;
  mobility: string;
}

export interface PositionView {
  t_ms: number;
  north_m: number;
  east_m: number;
  down_m: number;
  floor: number | null;
  ellipse_major_m: number;
  ellipse_minor_m: number;
  ellipse_heading_rad: number;
  std_down_m: number;
  heading_rad: number;
  heading_std_rad: number;
  quality: string;
  quality_reason: string;
  since_gps_s: number | null;
  lat_deg: number | null;
  lon_deg: number | null;
  floor_probability: number | null;
  reach: [number, number][];
  floor_down_m: number | null;
}

export interface DutyView {
  checked_in_ms: number | null;
  checked_in_by: string;
  due_ms: number;
  asked_ms: number | null;
  work_since_ms: number | null;
  rest_since_ms: number | null;
  rest_due_ms: number | null;
  confirmed: "self" | "radio" | "not_yet";
  on_duty_ms: number;
  located: boolean;
  entry_id: string;
}

export interface TrustView {
  level: "green" | "amber" | "red";
  reason: string;
  reason_codes: TextCodeView[];
}

export interface PreflightView {
  level: "ok" | "warning" | "failed";
  text: string;
  findings: string[];
  finding_codes: TextCodeView[];
}

export interface WornSensorView {
  name: string;
  place: string;
  place_recognised: boolean;
  mount: string;
  model: string;
}

export interface ClockView {
  ahead_ms: number;
  std_ms: number;
}

export interface UnitView {
  unit_id: string;
  label: string;
  registered: boolean;
  person: PersonView | null;
  link: "live" | "lost" | "never" | "stale";
  last_heard_ms: number | null;
  status: StatusView | null;
  status_ms: number | null;
  ambient_degc: number | null;
  heat_level: string;
  heat_used: number;
  position: PositionView | null;
  inside_since_ms: number | null;
  duty: DutyView | null;
  alarms: string[];
  trust: TrustView;
  clock: ClockView | null;
  cloned: boolean;
  gps: string | null;
  switched_off: boolean;
  ambient_ms: number | null;
  ambient_sensors: SensorTemperatureView[];
  can_be_notified: boolean | null;
  preflight: PreflightView | null;
  tracker: string;
  sensors: WornSensorView[];
  incident_id: string | null;
}

export interface AlarmParametersView {
  member?: string;
  member_before?: string;
  unit_id?: string;
  duration_s?: number;
  temperature_degc?: number;
  heat_fraction?: number;
  battery_fraction?: number;
  radius_m?: number;
  reasons?: string[];
  fault?: string;
  part?: string;
  calibrated_s?: number;
  fault_code?: string;
  fault_texts?: Record<string, string>;
  fault_numbers?: Record<string, number>;
}

export interface AlarmView {
  alarm_id: string;
  rule: string;
  unit_id: string;
  priority: number;
  state: string;
  level: string;
  text: string;
  by: string;
  raised_ms: number;
  last_raised_ms: number;
  changed_ms: number;
  code: string;
  parameters: AlarmParametersView;
  reason: string;
  note: string;
  peak: number | null;
}

export interface DeliveryView {
  unit_id: string;
  state: "queued" | "sent" | "received" | "notified" | "acknowledged" | "refused" | "expired";
  sent_ms: number | null;
  received_ms: number | null;
  notified_ms: number | null;
  acknowledged_ms: number | null;
  acknowledged_by: string;
  reason: string;
  acknowledged_via: "self" | "radio" | "";
  can_be_notified: boolean | null;
  repeated_ms: number | null;
  ended_ms: number | null;
  signal: "sound" | "light" | "";
  reason_code: TextCodeView | null;
}

export interface CommandView {
  command_id: string;
  kind: string;
  text: string;
  issued_by: string;
  issued_ms: number;
  expires_ms: number;
  asks_wearer: boolean;
  notifies_wearer: boolean;
  open: boolean;
  units: DeliveryView[];
  incident_id: string;
  ended_ms: number | null;
  ended_command_id: string;
}

export interface DispatchView {
  number: string;
  source: string;
  type: string;
  type_code: string;
  priority: string;
  address: string;
  lat_deg: number | null;
  lon_deg: number | null;
  units: string[];
  called_ms: number | null;
  dispatched_ms: number | null;
  updated_ms: number | null;
  remarks: string;
  has_ended: boolean;
  warnings: string[];
  received_ms: number | null;
  is_dismissed: boolean;
  warning_codes: TextCodeView[];
}

export interface IncidentView {
  incident_id: string;
  name: string;
  opened_ms: number;
  closed_ms: number | null;
  par_interval_s: number;
  par_warning_s: number;
  work_limit_s: number;
  dispatch: DispatchView | null;
  site_id: string;
}

export interface PinView {
  pin_id: string;
  kind: "place" | "start" | "meeting" | "beacon" | "tag";
  unit_id: string;
  other_id: string;
  t_ms: number;
  north_m: number | null;
  east_m: number | null;
  floor: number | null;
  std_m: number;
  heading_rad: number | null;
  heading_std_rad: number;
  note: string;
  by: string;
  set_ms: number;
  state: "used" | "conflict" | "waiting";
  residual_m: number | null;
  sigmas: number | null;
  text: string;
  text_code: TextCodeView | null;
}

export interface BeaconView {
  beacon_id: string;
  label: string;
  north_m: number;
  east_m: number;
  floor: number | null;
  std_m: number;
  reach_m: number;
  seen_ms: number | null;
  site_id: string;
}

export interface ExternalMarkerView {
  marker_id: string;
  source: string;
  name: string;
  kind: "person" | "marker" | "emergency";
  remarks: string;
  north_m: number;
  east_m: number;
  radius_m: number | null;
  t_ms: number;
  stale_ms: number;
  site_id: string;
}

export interface AnchorView {
  lat_deg: number;
  lon_deg: number;
  height_m: number;
  plan_rotation_rad: number;
}

export interface SiteView {
  site_id: string;
  plan: Plan | null;
  anchor: AnchorView | null;
  plan_placed: boolean;
}

export interface StandbyView {
  station: string;
  role: string;
  url: string;
  other: string;
  other_role: string;
  other_url: string;
  in_step: boolean;
}

export interface RecordingView {
  fetch_id: string;
  unit_id: string;
  state: string;
  problem: string;
  done_bytes: number;
  total_bytes: number;
  problem_code: TextCodeView | null;
}

export interface ForwarderView {
  name: string;
  kind: string;
  address: string;
  state: "connected" | "connecting" | "standby";
  since_ms: number | null;
  sent: number;
  received: number;
  refused: number;
  text: string;
}

export interface RadioView {
  name: string;
  source: string;
  state: "recording" | "away";
  problem: string;
}

export interface ArchiveView {
  location: string;
  state: "waiting" | "copying" | "away";
  waiting: number;
  copied: number;
  archived_ms: number | null;
  text: string;
}

export interface HealthView {
  problems: string[];
  messages: number;
  undecodable: number;
  unknown_units: number;
  log_bytes: number;
  disk_free_bytes: number;
  messages_per_s: number;
  insecure: boolean;
  standby: StandbyView | null;
  recordings: RecordingView[];
  repeated: number;
  left_out: number;
  missing: number;
  forwarders: ForwarderView[];
  radio: RadioView[];
  archive: ArchiveView | null;
  reading: number | null;
  problem_codes: TextCodeView[];
}

export interface GapView {
  from_ms: number;
  until_ms: number;
}

export interface ReplayView {
  incident_id: string;
  start_ms: number;
  end_ms: number;
  at_ms: number;
  speed: number;
  playing: boolean;
  seeking: boolean;
  flaws: string[];
  gap: GapView | null;
}

export type TrailPoint = [
  t_ms: number,
  north_m: number,
  east_m: number,
  floor: number | null,
  after_gap?: 0 | 1,
];

export interface Trail {
  type: "trail";
  unit_id: string;
  points: TrailPoint[];
}

export interface Snapshot {
  type: "snapshot";
  seq: number;
  now_ms: number;
  incident: IncidentView | null;
  units: UnitView[];
  alarms: AlarmView[];
  commands: CommandView[];
  pins: PinView[];
  beacons: BeaconView[];
  external: ExternalMarkerView[];
  plan: Plan | null;
  anchor: AnchorView | null;
  health: HealthView;
  replay: ReplayView | null;
  incidents: IncidentView[];
  sites: SiteView[];
  plan_placed: boolean;
  dispatches: DispatchView[];
}

export interface Delta {
  type: "delta";
  seq: number;
  now_ms: number;
  units?: UnitView[];
  alarms?: AlarmView[];
  commands?: CommandView[];
  trails?: Record<string, TrailPoint[]>;
  pins?: PinView[];
  beacons?: BeaconView[];
  external?: ExternalMarkerView[];
  health?: HealthView;
  incident?: IncidentView;
  replay?: ReplayView;
}

export interface FieldDelta {
  type: "field_delta";
  seq: number;
  after_seq: number;
  now_ms: number;
  units?: Record<string, UnitChange>;
  passed?: Record<string, TrailPoint[]>;
  alarms?: AlarmView[];
  commands?: CommandView[];
  trails?: Record<string, TrailPoint[]>;
  pins?: PinView[];
  beacons?: BeaconView[];
  external?: ExternalMarkerView[];
  health?: HealthView;
  incident?: IncidentView;
  replay?: ReplayView;
}

export type Link = UnitView["link"];
export type DeliveryState = DeliveryView["state"];
export type Message = Snapshot | Trail | FieldDelta;

/** The fields of a unit that changed: all of them for a unit that is new. */
export type UnitChange = Changed<UnitView>;
type Changed<T> = { [K in keyof T]?: T[K] extends readonly unknown[] ? T[K] : ChangedValue<T[K]> };
type ChangedValue<V> = V extends object ? (V extends readonly unknown[] ? V : Changed<V>) : V;
