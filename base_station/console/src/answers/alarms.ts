/** Requests and answers about alarms.
 *
 * Generated from the OpenAPI document of the station, which describes every field; after a change
 * there run `python -m tests.rig.console_types`.
 */
import type { AlarmHistoryEntry, AlarmParametersView } from "./common";

export interface Acknowledgement {
  last_raised_ms: number;
}

export interface AlarmExplanationAnswer {
  alarm_id: string;
  rule: string;
  raised_ms: number;
  motionless_s: TracePoint[];
  temperature_degc: TracePoint[];
  battery_level: TracePoint[];
  height_m: TracePoint[];
  stated_error_m: TracePoint[];
  live_ms: number[];
  buttons_ms: number[];
  thresholds: Record<string, number>;
  crossing: ThresholdCrossing | null;
}

export interface AlarmWithLife {
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
}

export interface Resolution {
  last_raised_ms: number;
  reason?: ResolutionReason | null;
  note?: string;
}

export type ResolutionReason = "false_alarm" | "member_well" | "found_and_helped" | "cause_removed" | "unit_fault" | "training" | "other";

export interface ThresholdCrossing {
  series: string;
  threshold: string;
  limit: number;
  t_ms: number;
  value: number;
}

export interface TracePoint {
  t_ms: number;
  value: number;
}
