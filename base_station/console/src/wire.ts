/** What the station says over the WebSocket: the mirror of `base_station/views/wire.py`.
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
  floor_probability: number | null;
  reach: [number, number][]; // [east_m, north_m]; where a silent wearer may be, by the walls
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
  last_raised_ms: number; // at first, or anew: it got worse, or happened again
  changed_ms: number;
}

/** While an incident is open: when somebody vouched for the wearer, and work and rest. */
export interface DutyView {
  checked_in_ms: number;
  checked_in_by: string;
  due_ms: number; // of the next check-in
  asked_ms: number | null; // a roll call was asked for, and is not answered
  work_since_ms: number | null;
  rest_since_ms: number | null;
  rest_due_ms: number | null;
}

/** How far the place of a unit can be trusted, as a light. */
export interface TrustView {
  level: "green" | "amber" | "red";
  reason: string; // empty: green
}

/** Where somebody was, as a person or a beacon told, and what became of it. */
export interface PinView {
  pin_id: string;
  kind: "place" | "start" | "meeting" | "beacon" | "tag";
  unit_id: string;
  other_id: string; // the beacon or tag, or the other unit of a meeting; else empty
  t_ms: number; // 0: where the unit's path begins
  north_m: number | null; // null: a meeting, or a beacon that nobody has placed yet
  east_m: number | null;
  floor: number | null;
  std_m: number;
  heading_rad: number | null;
  heading_std_rad: number;
  note: string;
  by: string; // who set it; the unit itself where that saw it
  set_ms: number;
  state: "used" | "conflict" | "waiting";
  residual_m: number | null; // between the pin and the trail
  sigmas: number | null; // the same in standard deviations of what was expected
  text: string; // for a person: what it conflicts with, or what it waits for
}

/** A beacon or tag that hangs at a known place. */
export interface BeaconView {
  beacon_id: string;
  label: string;
  north_m: number;
  east_m: number;
  floor: number | null;
  std_m: number;
  reach_m: number;
  seen_ms: number | null; // when a unit last saw it
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
  heat_used: number; // part of the equipment's heat budget, in this incident
  position: PositionView | null;
  inside_since_ms: number | null;
  duty: DutyView | null;
  alarms: string[]; // ids of the alarms that are not resolved
  trust: TrustView;
  clock: ClockView | null; // null: it has not heard the station's time yet
  cloned: boolean; // two machines speak under its name; one of them is shown
  gps: string | null; // why its last fix is not used; empty: it is; null: none has come
  switched_off: boolean; // in order: its silence since is no loss
}

/** What a unit knows of the station's time. */
export interface ClockView {
  ahead_ms: number; // the unit's own UTC less the station's
  std_ms: number;
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
  par_interval_s: number; // everybody is to be heard from this often
  par_warning_s: number; // how long before it is due a check-in is announced
  work_limit_s: number;
}

/** Which of two stations this is. */
export interface StandbyView {
  station: string;
  role: string; // active | standby | waiting
  url: string; // where consoles find it
  other: string; // "" while the other has not been heard
  other_role: string; // "" while it is not heard
  other_url: string;
  in_step: boolean; // the standby has what the active station has
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
  standby: StandbyView | null; // null: this is the only station
  recordings: RecordingView[];
  repeated: number; // messages since the station started that came again and were kept once
  reading: number | null; // share of its log; nothing is live: what was last stored is shown
}

/** A unit's raw recording that somebody asked for, on its way over the bus. */
export interface RecordingView {
  fetch_id: string;
  unit_id: string;
  state: string; // waiting | fetching | done | failed
  problem: string; // a sentence for a person
  done_bytes: number;
  total_bytes: number; // 0: not known yet
}

export interface ReplayView {
  incident_id: string;
  start_ms: number;
  end_ms: number;
  at_ms: number;
  speed: number;
  playing: boolean;
  seeking: boolean; // on the way to `at_ms`; what is shown is of another time
  flaws: string[]; // why not all is shown as it was, in words
}

export type TrailPoint = [t_ms: number, north_m: number, east_m: number, floor: number | null];

export interface AnchorView {
  lat_deg: number;
  lon_deg: number;
  height_m: number;
  plan_rotation_rad: number;
}

/** GeoJSON whose coordinates are `[east_m, north_m]` in the incident frame; `base_station/site/plan.py`
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
  pins: PinView[]; // in the order of setting
  beacons: BeaconView[];
  plan: Plan | null;
  anchor: AnchorView | null;
  health: HealthView;
  replay: ReplayView | null;
}

/** Where a unit was before the last snapshot; deltas since then have gone on from there. */
export interface Trail {
  type: "trail";
  unit_id: string;
  points: TrailPoint[];
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
  pins?: PinView[]; // all of them, where any changed
  beacons?: BeaconView[];
  health?: HealthView;
  incident?: IncidentView;
  replay?: ReplayView;
}

export type Message = Snapshot | Trail | Delta;
