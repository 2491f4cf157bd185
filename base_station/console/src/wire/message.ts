/** Messages of the station to the console, over the WebSocket.
 *
 * Generated from `base_station/views/wire`, which describes every field; after a change there run
 * `python -m tests.rig.console_types`.
 */
import type { AlarmView, CommandView, DispatchView, IncidentView } from "./incident";
import type { AnchorView, BeaconView, ExternalMarkerView, PinView, Plan, SiteView } from "./site";
import type { HealthView, ReplayView } from "./station";
import type { UnitChange, UnitView } from "./unit";

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

export type Message = Snapshot | Trail | FieldDelta;
