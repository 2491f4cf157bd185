/** Requests and answers about incidents and dispatches.
 *
 * Generated from the OpenAPI document of the station, which describes every field; after a change
 * there run `python -m tests.rig.console_types`.
 */
import type { AlarmHistoryEntry, AlarmParametersView, CrewTarget, EveryoneTarget, FloorTarget, TextCodeView, UnitTarget } from "./common";

export interface AlertReceipt {
  alert_id: string;
  outcome: string;
  markers: number;
  replaced: string[];
  warnings: string[];
  warning_codes: TextCodeView[];
}

export interface CallSignAnswer {
  call_sign: string;
  words: string;
  crew: string;
  unit_ids: string[];
}

export interface ClosingForm {
  despite_alarm_ids?: string[];
  despite_unit_ids?: string[];
}

export interface Dismissal {
  number: string;
}

export interface DispatchReceipt {
  number: string;
  outcome: "offered" | "updated" | "unchanged" | "outdated" | "opened";
  incident_id: string | null;
  units: CallSignAnswer[];
  warnings: string[];
  warning_codes: TextCodeView[];
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

export interface EpisodeChange {
  incident_id: string;
  unit_id: string;
  rule: string;
  level: string;
  outcome: EpisodeOutcome;
  recorded_ms: number | null;
  rehearsed_ms: number | null;
}

export type EpisodeOutcome = "same" | "earlier" | "later" | "missed" | "added";

export interface Figures {
  ce50_m: number;
  ce95_m: number;
  ve50_m: number;
  ve95_m: number;
  se50_m: number;
  se95_m: number;
}

export interface ImportAnswer {
  import_id: string;
  file_name: string;
  format: string;
  sha256: string;
  size_bytes: number;
  shift_s: number;
  from_ms: number;
  until_ms: number;
  t_ms: number;
  by: string;
  is_here: boolean;
  tracks: number;
  names: string[];
  warnings: string[];
  warning_codes: TextCodeView[];
}

export interface ImportedTrackAnswer {
  name: string;
  points: [number, number, number, number | null][];
}

export interface ImportedTracks {
  import_id: string;
  format: string;
  file_name: string;
  picture_url: string | null;
  tracks: ImportedTrackAnswer[];
}

export interface IncidentAnswer {
  incident_id: string;
  name: string;
  opened_ms: number;
  opened_by: string;
  closed_ms: number | null;
  closed_by: string;
  dispatch_number: string;
  archived_ms: number | null;
  erased_at_ms: number | null;
}

export interface IncidentReport {
  incident_id: string;
  smoother: string;
  made_ms: number;
  units: UnitReport[];
  stated: Figures | null;
  against_smoothed: Figures | null;
  flaws: string[];
  flaw_codes: TextCodeView[];
  is_newest: boolean;
}

export interface LevelFigures {
  rule: string;
  level: string;
  recorded: number;
  rehearsed: number;
  same: number;
  earlier: number;
  later: number;
  missed: number;
  added: number;
  median_shift_s: number | null;
  recorded_per_hour: number | null;
  rehearsed_per_hour: number | null;
}

export interface Member {
  unit_id: string;
  person_id: string | null;
  name: string;
  crew: string;
}

export interface NewIncident {
  name: string;
  par_interval_s?: number | null;
  work_limit_s?: number | null;
  dispatch_number?: string;
  beside_others?: boolean;
}

export interface NewMembers {
  target: UnitTarget | CrewTarget | FloorTarget | EveryoneTarget;
}

export interface OfferedDispatch {
  dispatch: DispatchView;
  call_signs: CallSignAnswer[];
}

export interface PastAlarm {
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
  changes: AlarmHistoryEntry[];
  raisings: Raising[];
}

export interface PinResidual {
  pin_id: string;
  note: string;
  used: boolean;
  shown_m: number | null;
  trail_m: number;
  sigmas: number;
  floor_right: boolean | null;
}

export interface Raising {
  t_ms: number;
  text: string;
  code: string;
  parameters: AlarmParametersView;
}

export interface RehearsalAnswer {
  incident_id: string;
  worn_h: number;
  live_alarms: Record<string, number>;
  swept: string;
  points: RehearsedPoint[];
  wearers: Record<string, string[]>;
  flaws: string[];
  flaw_codes: TextCodeView[];
}

export interface RehearsedPoint {
  thresholds: Record<string, number>;
  problem: string;
  levels: LevelFigures[];
  changes: EpisodeChange[];
}

export interface ThresholdAnswer {
  rule: string;
  threshold: string;
  value: number;
  lowest: number;
  highest: number;
}

export interface TrustReport {
  green_s: number;
  amber_s: number;
  red_s: number;
  causes: [string, number][];
}

export interface UnitReport {
  unit_id: string;
  seconds: number;
  walked_m: number;
  stated: Figures | null;
  against_smoothed: Figures | null;
  floor_probability: number | null;
  floor_right: number | null;
  trust: TrustReport;
  pin_residuals: PinResidual[];
  loop_closure_m: number | null;
  loop_closure_percent: number | null;
  reentry_jumps_m: number[];
  not_used: [string, number][];
  people: string[];
}
