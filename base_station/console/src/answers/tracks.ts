/** Requests and answers about recorded tracks: timeline, replay, export.
 *
 * Generated from the OpenAPI document of the station, which describes every field; after a change
 * there run `python -m tests.rig.console_types`.
 */
import type { TextCodeView } from "./common";

export interface Format {
  name: string;
  suffix: string;
  needs_anchor: boolean;
}

export interface GapView {
  from_ms: number;
  until_ms: number;
}

export interface NewReplay {
  incident_id: string;
  speed?: number;
}

export interface Replay {
  incident_id: string;
  start_ms: number;
  end_ms: number;
  at_ms: number;
  speed: number;
  playing: boolean;
  seeking: boolean;
  flaws: string[];
  flaw_codes: TextCodeView[];
  gap: GapView | null;
  replay_id: string;
  begun_by: string;
}

export interface ReplayChange {
  at_ms?: number | null;
  speed?: number | null;
  playing?: boolean | null;
}

export interface TimelineAnswer {
  unit_id: string;
  from_ms: number;
  until_ms: number;
  temperature_degc: TimelineColumn;
  height_m: TimelineColumn;
  floor: TimelineColumn;
  activity: TimelineColumn;
  activity_names: string[];
  battery: TimelineColumn;
  position_error_m: TimelineColumn;
  silence_s: TimelineColumn;
  radio_gaps_ms: [number, number][];
  defects: string[];
  defect_codes: TextCodeView[];
}

export interface TimelineColumn {
  t_ms: number[];
  values: (number | null)[];
}

export interface Track {
  unit_id: string;
  points: TrackPointAnswer[];
}

export interface TrackPointAnswer {
  t_ms: number;
  north_m: number;
  east_m: number;
  down_m: number;
  std_north_m: number;
  std_east_m: number;
  std_down_m: number;
  heading_rad: number;
  floor: number | null;
  quality: string;
}

export interface TrailAnswer {
  unit_id: string;
  points: [number, number, number, number | null][];
}

export type TrailKind = "raw" | "fused" | "smoothed";

export interface Trails {
  incident_id: string;
  kind: TrailKind;
  made_ms: number;
  is_newest: boolean;
  trails: TrailAnswer[];
}
