/** Requests and answers about units: enrolment, recordings, radio, samples.
 *
 * Generated from the OpenAPI document of the station, which describes every field; after a change
 * there run `python -m tests.rig.console_types`.
 */
import type { TextCodeView } from "./common";

export interface EnrolledUnit {
  unit_id: string;
  valid_to_ms: number;
}

export interface Label {
  label: string;
}

export interface NewEnrolment {
  unit_id: string;
  days?: number;
  renew?: boolean;
}

export interface NewPull {
  unit_id: string;
  incident_id?: string | null;
  from_ms?: number | null;
  to_ms?: number | null;
}

export interface NewUnit {
  unit_id: string;
  label?: string;
}

export interface NewUnitToken {
  days?: number | null;
}

export interface PostedSamples {
  boot_id: number;
  batches: SampleBatch[];
}

export interface RadioAnswer {
  from_ms: number;
  until_ms: number;
  channels: RadioChannelAnswer[];
}

export interface RadioChannelAnswer {
  name: string;
  recorded_ms: [number, number][];
  voice_ms: [number, number][];
}

export interface Recording {
  fetch_id: string;
  unit_id: string;
  by: string;
  from_ms: number;
  to_ms: number;
  state: string;
  problem: string;
  done_bytes: number;
  total_bytes: number;
  problem_code?: TextCodeView | null;
}

export interface Reference {
  unit_id: string;
  incident_id?: string | null;
  down_m?: number;
}

export interface SampleBatch {
  seq: number;
  t_ns: number[];
  accel_mps2: ((number | null)[])[];
  gyro_radps: ((number | null)[])[];
  mag_ut?: ((number | null)[])[] | null;
  pressure_pa?: (number | null)[] | null;
  imu_temperature_degc?: (number | null)[] | null;
}

export interface SamplesReceipt {
  accepted: number;
  repeated: number;
  samples: number;
}

export interface ShownEnrolment {
  unit_id: string;
  valid_to_ms: number;
  text: string;
  qr_rows: string[];
}

export interface UnitAnswer {
  unit_id: string;
  label: string;
  registered: boolean;
  person_id: string | null;
  last_heard_ms: number | null;
  software_version: string;
  source: string;
  sensor_name: string;
  tracker: string;
  calibration: string;
  has_gps: boolean;
  sensors: WornSensorView[];
}

export interface UnitStartForm {
  north_m: number;
  east_m: number;
  down_m?: number;
  heading_rad?: number;
  std_m?: number;
  heading_std_rad?: number;
}

export interface UnitToken {
  token_id: string;
  username: string;
  created_ms: number;
  expires_ms: number | null;
}

export interface UnitTokenSecret {
  token_id: string;
  token: string;
}

export interface WornSensorView {
  name: string;
  place: string;
  place_recognised: boolean;
  mount: string;
  model: string;
}
