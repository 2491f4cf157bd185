/** Requests and answers about the site: plan, base map, anchor, pins, beacons.
 *
 * Generated from the OpenAPI document of the station, which describes every field; after a change
 * there run `python -m tests.rig.console_types`.
 */
import type { TextCodeView } from "./common";

export interface AnchorForm {
  lat_deg: number;
  lon_deg: number;
  height_m?: number;
  plan_rotation_rad?: number;
}

export interface AnchorView {
  lat_deg: number;
  lon_deg: number;
  height_m: number;
  plan_rotation_rad: number;
}

export interface BaseMapAnswer {
  image_url: string;
  upper_left: [number, number];
  upper_right: [number, number];
  lower_left: [number, number];
}

export interface BeaconForm {
  label?: string;
  north_m: number;
  east_m: number;
  floor?: number | null;
  std_m?: number;
  reach_m?: number;
  incident_id?: string | null;
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

export interface DrawnPictureAnswer {
  webp: string;
  width_px: number;
  height_px: number;
}

export interface MeetingForm {
  unit_id: string;
  other_unit_id: string;
  t_ms?: number | null;
  std_m?: number;
  note?: string;
}

export interface PinForm {
  north_m: number;
  east_m: number;
  std_m?: number;
  floor?: number | null;
  heading_rad?: number | null;
  heading_std_rad?: number;
  note?: string;
  unit_id: string;
  t_ms?: number | null;
}

export interface PinView {
  pin_id: string;
  kind: string;
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
  state: string;
  residual_m: number | null;
  sigmas: number | null;
  text: string;
  text_code: TextCodeView | null;
}

export interface PlanDraft {
  picture: DrawnPictureAnswer | null;
  plan: object | null;
  lat_deg: number | null;
  lon_deg: number | null;
  plan_rotation_rad: number;
  is_place_surveyed: boolean;
  pages: number;
  notes: string[];
  note_codes: TextCodeAnswer[];
}

export interface StartForm {
  north_m: number;
  east_m: number;
  std_m?: number;
  floor?: number | null;
  heading_rad?: number | null;
  heading_std_rad?: number;
  note?: string;
  unit_ids: string[];
  t_ms?: number;
}

export interface TextCodeAnswer {
  code: string;
  texts: Record<string, string>;
  numbers: Record<string, number>;
}
