/** Units and their wearers, as the live picture shows them.
 *
 * Generated from `base_station/views/wire`, which describes every field; after a change there run
 * `python -m tests.rig.console_types`.
 */

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

export type Link = UnitView["link"];

/** The fields of a unit that changed: all of them for a unit that is new. */
export type UnitChange = Changed<UnitView>;
type Changed<T> = { [K in keyof T]?: T[K] extends readonly unknown[] ? T[K] : ChangedValue<T[K]> };
type ChangedValue<V> = V extends object ? (V extends readonly unknown[] ? V : Changed<V>) : V;
