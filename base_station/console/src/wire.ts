/** What the station says over the WebSocket: the mirror of `base_station/api/wire.py`.
 *
 * Times are milliseconds since 1970 in station time (in a replay, the time of the incident);
 * positions are metres north, east and down in the incident frame.
 */
import type { FeatureCollection } from "geojson";

export type Link = "live" | "stale" | "lost" | "never";

export interface PersonView {
  person_id: string;
  name: string;
  crew: string;
  role: string;
  photo_url: string | null;
}

export interface StatusView {
  activity: string;
  motionless_s: number;
  battery: number | null; // 0..1
  mayday: boolean;
  steps: number;
  distance_m: number;
}

export interface PositionView {
  t_ms: number; // the time to which the position belongs
  north_m: number;
  east_m: number;
  down_m: number;
  floor: number | null;
  ellipse_major_m: number; // semi-axes of the 95 % region
  ellipse_minor_m: number;
  ellipse_heading_rad: number; // of the major axis, clockwise from north
  std_down_m: number;
  heading_rad: number;
  heading_std_rad: number;
  quality: string;
  quality_reason: string;
  since_gps_s: number | null;
  lat_deg: number | null;
  lon_deg: number | null;
}

export interface AlarmView {
  alarm_id: string;
  rule: string;
  unit_id: string; // empty: the station itself
  priority: number;
  state: string; // raised | acknowledged | resolved
  level: string;
  text: string;
  by: string;
  raised_ms: number;
  changed_ms: number;
}

export interface UnitView {
  unit_id: string;
  label: string;
  registered: boolean;
  person: PersonView | null;
  link: Link;
  last_heard_ms: number | null;
  status: StatusView | null;
  status_ms: number | null;
  ambient_degc: number | null;
  heat_level: string; // "" | caution | warning | critical
  position: PositionView | null;
  inside_since_ms: number | null;
  alarms: string[]; // ids of the alarms that are not resolved
}

export type DeliveryState =
  | "queued"
  | "sent"
  | "received"
  | "acknowledged"
  | "refused"
  | "expired";

/** How far a command has got with one unit. */
export interface DeliveryView {
  unit_id: string;
  state: DeliveryState;
  sent_ms: number | null;
  received_ms: number | null;
  acknowledged_ms: number | null;
  acknowledged_by: string; // the wearer, or who heard from the wearer
  reason: string; // of a refusal
}

/** What units were told. */
export interface CommandView {
  command_id: string;
  kind: string;
  text: string;
  issued_by: string;
  issued_ms: number;
  expires_ms: number;
  asks_wearer: boolean; // done only when somebody has acknowledged it
  open: boolean; // more is to come of it
  units: DeliveryView[];
}

export interface IncidentView {
  incident_id: string;
  name: string;
  opened_ms: number;
  closed_ms: number | null;
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
}

export interface ReplayView {
  incident_id: string;
  start_ms: number;
  end_ms: number;
  at_ms: number;
  speed: number;
  playing: boolean;
}

export type TrailPoint = [t_ms: number, north_m: number, east_m: number, floor: number | null];

export interface AnchorView {
  lat_deg: number;
  lon_deg: number;
  height_m: number;
  plan_rotation_rad: number;
}

/** GeoJSON whose coordinates are `[east_m, north_m]` in the incident frame; `base_station/plan.py`
 * says more. */
export interface Plan extends FeatureCollection {
  muster: { frame: "site-m"; name?: string; floors?: PlanFloor[] };
}

export interface PlanFloor {
  floor: number;
  down_m: number;
}

export interface Snapshot {
  type: "snapshot";
  seq: number;
  now_ms: number;
  incident: IncidentView | null;
  units: UnitView[];
  alarms: AlarmView[];
  commands: CommandView[]; // all that are open, and the last closed ones; oldest first
  trails: Record<string, TrailPoint[]>;
  plan: Plan | null;
  anchor: AnchorView | null;
  health: HealthView;
  replay: ReplayView | null;
}

/** What changed since the message before; what is absent is as it was. */
export interface Delta {
  type: "delta";
  seq: number;
  now_ms: number;
  units?: UnitView[];
  alarms?: AlarmView[];
  commands?: CommandView[];
  trails?: Record<string, TrailPoint[]>;
  health?: HealthView;
  incident?: IncidentView;
  replay?: ReplayView;
}

export type Message = Snapshot | Delta;
