/** Requests and answers about people: roster, duty, assignments, erasure.
 *
 * Generated from the OpenAPI document of the station, which describes every field; after a change
 * there run `python -m tests.rig.console_types`.
 */
import type { CrewTarget, EveryoneTarget, FloorTarget, TextCodeView, UnitTarget } from "./common";

export interface AssignmentAnswer {
  unit_id: string;
  person_id: string;
  person_name: string;
  crew: string;
  role: string;
  from_ms: number;
  until_ms: number | null;
}

export interface FaultyLine {
  line: number;
  fault: string;
  fault_code: TextCodeView | null;
}

export interface ListedPersonAnswer {
  line: number;
  name: string;
  crew: string;
  role: string;
  change: "add" | "change" | "same";
}

export interface NameConfirmation {
  name: string;
}

export interface NewAssignment {
  unit_id: string;
  person_id: string;
}

export interface NewCheckIn {
  target: UnitTarget | CrewTarget | FloorTarget | EveryoneTarget;
  incident_id?: string | null;
  check_in_id?: string | null;
}

export interface OnDuty {
  unit_id: string;
  incident_id: string;
  person_id: string;
  name: string;
  crew: string;
  state: string;
  left_s: number;
  checked_in_ms: number | null;
  checked_in_by: string;
  asked_ms: number | null;
  work_since_ms: number | null;
  rest_since_ms: number | null;
  confirmed: string;
  on_duty_ms: number;
  located: boolean;
  entry_id: string;
}

export interface PeopleImport {
  people: ListedPersonAnswer[];
  faulty_lines: FaultyLine[];
}

export interface PersonConfirmation {
  name: string;
  unassign?: boolean;
}

export interface PersonForm {
  name: string;
  crew?: string;
  role?: string;
}

export interface PersonView {
  person_id: string;
  name: string;
  crew: string;
  role: string;
  photo_url: string | null;
}

export interface Progress {
  forgetting_id: string;
  by: string;
  kind: string;
  subject_id: string;
  state: string;
  problem: string;
  share: number;
  records: number;
  files: number;
  problem_code?: TextCodeView | null;
}

export interface Rest {
  resting: boolean;
}

export interface Times {
  par_interval_s: number;
  work_limit_s: number;
}

export interface UndoCheckIn {
  unit_id?: string;
}
