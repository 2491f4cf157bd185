/** Pins, beacons, markers and anchors, as the live picture shows them.
 *
 * Generated from `base_station/views/wire`, which describes every field; after a change there run
 * `python -m tests.rig.console_types`.
 */
import type { Plan } from "../plan/planFile";
import type { TextCodeView } from "./unit";

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

export type { Plan };
