/** Requests and answers of several subjects.
 *
 * Generated from the OpenAPI document of the station, which describes every field; after a change
 * there run `python -m tests.rig.console_types`.
 */

export interface AlarmHistoryEntry {
  t_ms: number;
  state: string;
  level: string;
  text: string;
  by: string;
  code: string;
  parameters: AlarmParametersView;
  reason: string;
  note: string;
  peak: number | null;
}

export interface AlarmParametersView {
  member?: string | null;
  member_before?: string | null;
  unit_id?: string | null;
  duration_s?: number | null;
  temperature_degc?: number | null;
  heat_fraction?: number | null;
  battery_fraction?: number | null;
  radius_m?: number | null;
  reasons?: string[];
  fault?: string | null;
  part?: string | null;
  calibrated_s?: number | null;
  fault_code?: string | null;
  fault_texts?: Record<string, string>;
  fault_numbers?: Record<string, number>;
}

export interface CrewTarget {
  crew: string;
}

export interface EveryoneTarget {
  everyone: true;
}

export interface FloorTarget {
  floor: number;
}

export interface ProblemDocument {
  type: string;
  title: string;
  status: number;
  detail: string;
  code: string;
  parameters: Record<string, string | number>;
}

export interface TextCodeView {
  code: string;
  texts: Record<string, string>;
  numbers: Record<string, number>;
}

export interface UnitTarget {
  unit_id: string;
}
