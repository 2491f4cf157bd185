/** Answers of a department's API.
 *
 * Generated from `base_station/department/answers.py`, which describes every field; after a change
 * there run `python -m tests.rig.console_types`.
 */
import type { AlarmParametersView, TextCodeView } from "../wire";

export interface ReportingStationView {
  station: string;
  state: "live" | "away" | "never";
  last_ms: number | null;
  console_url: string;
  host: string;
  people: number;
  in_incident: number;
  waiting: number;
  missing: number;
  clock_ahead_ms: number;
  problems: string[];
  lat_deg: number | null;
  lon_deg: number | null;
  problem_codes: TextCodeView[];
}

export interface DepartmentIncidentView {
  station: string;
  incident_id: string;
  name: string;
  opened_ms: number;
  closed_ms: number | null;
  people: number;
  maydays: number;
  alarms: number;
  overdue: number;
}

export interface DepartmentIncidentsView {
  total: number;
  incidents: DepartmentIncidentView[];
}

export interface DepartmentAlarmView {
  station: string;
  alarm_id: string;
  rule: string;
  unit_id: string;
  person: string;
  priority: number;
  state: string;
  level: string;
  text: string;
  by: string;
  raised_ms: number;
  changed_ms: number;
  code: string;
  parameters: AlarmParametersView;
}

export interface DepartmentView {
  now_ms: number;
  stations: ReportingStationView[];
  incidents: DepartmentIncidentView[];
  alarms: DepartmentAlarmView[];
  open_alarms: number;
  people: number;
  problems: string[];
  has_archive: boolean;
  problem_codes: TextCodeView[];
}

export interface DepartmentPersonView {
  station: string;
  unit_id: string;
  label: string;
  person_id: string;
  name: string;
  crew: string;
  role: string;
  incident_id: string;
  link: "live" | "stale" | "lost" | "never" | "station_away";
  position_age_s: number | null;
  north_m: number | null;
  east_m: number | null;
  floor: number | null;
  lat_deg: number | null;
  lon_deg: number | null;
  radius_m: number | null;
  quality: string;
  activity: string;
  mayday: boolean;
  alarms: number;
  par: "self" | "radio" | "not_yet" | "";
  par_due_ms: number | null;
  par_overdue: boolean;
}

export interface DepartmentPeopleView {
  now_ms: number;
  total: number;
  people: DepartmentPersonView[];
}

export interface DepartmentEventView {
  number: number;
  station: string;
  kind: string;
  t_ms: number;
  received_ms: number;
  text: string;
}

export interface StartedReplay {
  port: number;
  username: string;
  password: string;
}
