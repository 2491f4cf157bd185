/** The station's health and replays, as the live picture shows them.
 *
 * Generated from `base_station/views/wire`, which describes every field; after a change there run
 * `python -m tests.rig.console_types`.
 */
import type { TextCodeView } from "./unit";

export interface StandbyView {
  station: string;
  role: string;
  url: string;
  other: string;
  other_role: string;
  other_url: string;
  in_step: boolean;
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

export interface ForwarderView {
  name: string;
  kind: string;
  address: string;
  state: "connected" | "connecting" | "standby";
  since_ms: number | null;
  sent: number;
  received: number;
  refused: number;
  text: string;
  text_code: TextCodeView | null;
}

export interface RadioView {
  name: string;
  source: string;
  state: "recording" | "away";
  problem: string;
  problem_code: TextCodeView | null;
}

export interface ArchiveView {
  location: string;
  state: "waiting" | "copying" | "away";
  waiting: number;
  copied: number;
  archived_ms: number | null;
  text: string;
  text_code: TextCodeView | null;
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
}

export interface GapView {
  from_ms: number;
  until_ms: number;
}

export interface ReplayView {
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
}
