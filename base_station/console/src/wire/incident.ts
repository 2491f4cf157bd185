/** Incidents, alarms, orders and dispatches, as the live picture shows them.
 *
 * Generated from `base_station/views/wire`, which describes every field; after a change there run
 * `python -m tests.rig.console_types`.
 */
import type { TextCodeView } from "./unit";

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

export type DeliveryState = DeliveryView["state"];
