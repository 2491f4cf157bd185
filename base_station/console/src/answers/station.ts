/** Requests and answers about the station: health, standby, audit.
 *
 * Generated from the OpenAPI document of the station, which describes every field; after a change
 * there run `python -m tests.rig.console_types`.
 */
import type { TextCodeView } from "./common";

export interface ArchiveView {
  location: string;
  state: string;
  waiting: number;
  copied: number;
  archived_ms: number | null;
  text: string;
  text_code: TextCodeView | null;
}

export interface AuditEntryAnswer {
  entry_id: string;
  t_ms: number;
  by: string;
  action: string;
  detail: string;
}

export interface CarriedOut {
  action: string;
  t_ms: number;
}

export interface ForwarderView {
  name: string;
  kind: string;
  address: string;
  state: string;
  since_ms: number | null;
  sent: number;
  received: number;
  refused: number;
  text: string;
  text_code: TextCodeView | null;
}

export interface Health {
  problems: string[];
  messages: number;
  undecodable: number;
  unknown_units: number;
  log_bytes: number;
  disk_free_bytes: number;
  messages_per_s: number;
  insecure: boolean;
  standby: StandbyView | null;
  recordings: RecordingView[];
  repeated: number;
  left_out: number;
  missing: number;
  forwarders: ForwarderView[];
  radio: RadioView[];
  archive: ArchiveView | null;
  reading: number | null;
  problem_codes: TextCodeView[];
  consoles: number;
  segments: LogSegmentAnswer[];
}

export interface Leads {
  leads: boolean;
}

export interface LogSegmentAnswer {
  name: string;
  first_ms: number;
  last_ms: number;
  messages: number;
  size_bytes: number;
  note: string;
}

export interface RadioView {
  name: string;
  source: string;
  state: string;
  problem: string;
  problem_code: TextCodeView | null;
}

export interface RecordingView {
  fetch_id: string;
  unit_id: string;
  state: string;
  problem: string;
  done_bytes: number;
  total_bytes: number;
  problem_code: TextCodeView | null;
}

export interface StandbyView {
  station: string;
  role: string;
  url: string;
  other: string;
  other_role: string;
  other_url: string;
  in_step: boolean;
}
