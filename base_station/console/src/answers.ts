/** Requests and answers of the station's API.
 *
 * Generated from its OpenAPI document, which describes every field; after a change there run
 * `python -m tests.rig.console_types`.
 */

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

export interface AlertReceipt {
  alert_id: string;
  outcome: string;
  markers: number;
  replaced: string[];
  warnings: string[];
  warning_codes: TextCodeView[];
}

export interface AllClear {
  expires_s?: number;
}

export interface AnchorForm {
  lat_deg: number;
  lon_deg: number;
  height_m?: number;
  plan_rotation_rad?: number;
}

export interface AnchorView {
  lat_deg: number;
  lon_deg: number;
  height_m: number;
  plan_rotation_rad: number;
}

export interface ArchiveView {
  location: string;
  state: string;
  waiting: number;
  copied: number;
  archived_ms: number | null;
  text: string;
}

export interface AssignmentAnswer {
  unit_id: string;
  person_id: string;
  person_name: string;
  crew: string;
  role: string;
  from_ms: number;
  until_ms: number | null;
}

export interface AuditEntryAnswer {
  entry_id: string;
  t_ms: number;
  by: string;
  action: string;
  detail: string;
}

export interface BaseMapAnswer {
  image_url: string;
  upper_left: [number, number];
  upper_right: [number, number];
  lower_left: [number, number];
}

export interface BeaconForm {
  label?: string;
  north_m: number;
  east_m: number;
  floor?: number | null;
  std_m?: number;
  reach_m?: number;
  incident_id?: string | null;
}

export interface BeaconView {
  beacon_id: string;
  label: string;
  north_m: number;
  east_m: number;
  floor: number | null;
  std_m: number;
  reach_m: number;
  seen_ms: number | null;
  site_id: string;
}

export interface CallSignAnswer {
  call_sign: string;
  words: string;
  crew: string;
  unit_ids: string[];
}

export interface CarriedOut {
  action: string;
  t_ms: number;
}

export interface ClosingForm {
  despite_alarm_ids?: string[];
  despite_unit_ids?: string[];
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

export interface Confirmation {
  unit_id: string;
}

export interface Credentials {
  username: string;
  password: string;
}

export interface CrewTarget {
  crew: string;
}

export interface DeliveryView {
  unit_id: string;
  state: string;
  sent_ms: number | null;
  received_ms: number | null;
  notified_ms: number | null;
  acknowledged_ms: number | null;
  acknowledged_by: string;
  reason: string;
  acknowledged_via: string;
  can_be_notified: boolean | null;
  repeated_ms: number | null;
  ended_ms: number | null;
  signal: string;
  reason_code: TextCodeView | null;
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

export interface DrawnPictureAnswer {
  webp: string;
  width_px: number;
  height_px: number;
}

export interface EnrolledUnit {
  unit_id: string;
  valid_to_ms: number;
}

export interface EveryoneTarget {
  everyone: true;
}

export interface FaultyLine {
  line: number;
  fault: string;
}

export interface Figures {
  ce50_m: number;
  ce95_m: number;
  ve50_m: number;
  ve95_m: number;
  se50_m: number;
  se95_m: number;
}

export interface FloorTarget {
  floor: number;
}

export interface Format {
  name: string;
  suffix: string;
  needs_anchor: boolean;
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
}

export interface GapView {
  from_ms: number;
  until_ms: number;
}

export interface GuideAnswer {
  rescuer_id: string;
  unit_id: string;
  by: string;
  text: string;
  sent_ms: number;
}

export interface GuideForm {
  rescuer_id: string;
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
  is_newest: boolean;
}

export type Kind = "evacuate" | "par_request" | "text" | "locate" | "set_position_rate";

export interface Label {
  label: string;
}

export interface Leads {
  leads: boolean;
}

export interface ListedPersonAnswer {
  line: number;
  name: string;
  crew: string;
  role: string;
  change: "add" | "change" | "same";
}

export interface LogSegmentAnswer {
  name: string;
  first_ms: number;
  last_ms: number;
  messages: number;
  size_bytes: number;
  note: string;
}

export interface Me {
  username: string;
  role: string;
  must_change_password: boolean;
}

export interface MeetingForm {
  unit_id: string;
  other_unit_id: string;
  t_ms?: number | null;
  std_m?: number;
  note?: string;
}

export interface Member {
  unit_id: string;
  person_id: string | null;
  name: string;
  crew: string;
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

export interface NewCommand {
  kind: Kind;
  target: UnitTarget | CrewTarget | FloorTarget | EveryoneTarget;
  text?: string;
  position_rate_hz?: number;
  incident_id?: string | null;
  expires_s?: number;
}

export interface NewEnrolment {
  unit_id: string;
  days?: number;
  renew?: boolean;
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

export interface NewPull {
  unit_id: string;
  incident_id?: string | null;
  from_ms?: number | null;
  to_ms?: number | null;
}

export interface NewReplay {
  incident_id: string;
  speed?: number;
}

export interface NewToken {
  name: string;
  role: "viewer" | "commander" | "administrator";
  scopes?: Scope[];
  days?: number | null;
}

export interface NewUnit {
  unit_id: string;
  label?: string;
}

export interface NewUnitToken {
  days?: number | null;
}

export interface NewUser {
  username: string;
  password: string;
  role: "viewer" | "commander" | "administrator";
}

export interface OfferedDispatch {
  dispatch: DispatchView;
  call_signs: CallSignAnswer[];
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

export interface PasswordChange {
  old_password: string;
  new_password: string;
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

export interface PinForm {
  north_m: number;
  east_m: number;
  std_m?: number;
  floor?: number | null;
  heading_rad?: number | null;
  heading_std_rad?: number;
  note?: string;
  unit_id: string;
  t_ms?: number | null;
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

export interface PinView {
  pin_id: string;
  kind: string;
  unit_id: string;
  other_id: string;
  t_ms: number;
  north_m: number | null;
  east_m: number | null;
  floor: number | null;
  std_m: number;
  heading_rad: number | null;
  heading_std_rad: number;
  note: string;
  by: string;
  set_ms: number;
  state: string;
  residual_m: number | null;
  sigmas: number | null;
  text: string;
  text_code: TextCodeView | null;
}

export interface PlanDraft {
  picture: DrawnPictureAnswer | null;
  plan: object | null;
  lat_deg: number | null;
  lon_deg: number | null;
  plan_rotation_rad: number;
  is_place_surveyed: boolean;
  pages: number;
  notes: string[];
  note_codes: TextCodeAnswer[];
}

export interface PostedSamples {
  boot_id: number;
  batches: SampleBatch[];
}

export interface ProblemDocument {
  type: string;
  title: string;
  status: number;
  detail: string;
  code: string;
  parameters: Record<string, string | number>;
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

export interface RadioView {
  name: string;
  source: string;
  state: string;
  problem: string;
}

export interface Raising {
  t_ms: number;
  text: string;
  code: string;
  parameters: AlarmParametersView;
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

export interface RecordingView {
  fetch_id: string;
  unit_id: string;
  state: string;
  problem: string;
  done_bytes: number;
  total_bytes: number;
  problem_code: TextCodeView | null;
}

export interface Reference {
  unit_id: string;
  incident_id?: string | null;
  down_m?: number;
}

export interface Repeat {
  unit_id?: string | null;
  expires_s?: number;
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
  gap: GapView | null;
  replay_id: string;
  begun_by: string;
}

export interface ReplayChange {
  at_ms?: number | null;
  speed?: number | null;
  playing?: boolean | null;
}

export interface Resolution {
  last_raised_ms: number;
  reason?: ResolutionReason | null;
  note?: string;
}

export type ResolutionReason = "false_alarm" | "member_well" | "found_and_helped" | "cause_removed" | "unit_fault" | "training" | "other";

export interface Rest {
  resting: boolean;
}

export interface RouteAnswer {
  unit_id: string;
  known: boolean;
  distance_m: number;
  uncertainty_m: number;
  crosses_walls: boolean;
  text: string;
  next_text: string;
  legs: RouteLegAnswer[];
  places: RoutePlace[];
}

export interface RouteLegAnswer {
  turn: "ahead" | "left" | "right" | "back" | null;
  bearing_rad: number;
  distance_m: number;
  floors: number;
}

export interface RoutePlace {
  north_m: number;
  east_m: number;
  floor: number | null;
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

export type Scope = "accountability" | "alarms" | "assignments" | "audit" | "commands" | "dispatch" | "enrolments" | "exports" | "forgetting" | "health" | "incidents" | "live" | "people" | "pins" | "radio" | "recordings" | "replays" | "samples" | "site" | "standby" | "tokens" | "tracks" | "units" | "users";

export interface ShownEnrolment {
  unit_id: string;
  valid_to_ms: number;
  text: string;
  qr_rows: string[];
}

export interface ShownTicket {
  ticket: string;
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

export interface StartForm {
  north_m: number;
  east_m: number;
  std_m?: number;
  floor?: number | null;
  heading_rad?: number | null;
  heading_std_rad?: number;
  note?: string;
  unit_ids: string[];
  t_ms?: number;
}

export interface TextCodeAnswer {
  code: string;
  texts: Record<string, string>;
  numbers: Record<string, number>;
}

export interface TextCodeView {
  code: string;
  texts: Record<string, string>;
  numbers: Record<string, number>;
}

export interface ThresholdCrossing {
  series: string;
  threshold: string;
  limit: number;
  t_ms: number;
  value: number;
}

export interface Ticket {
  ticket: string;
  lasts_s: number;
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
}

export interface TimelineColumn {
  t_ms: number[];
  values: (number | null)[];
}

export interface Times {
  par_interval_s: number;
  work_limit_s: number;
}

export interface Token {
  token_id: string;
  name: string;
  role: string;
  scopes: string[];
  created_ms: number;
  expires_ms: number | null;
}

export interface TokenSecret {
  token_id: string;
  token: string;
}

export interface TracePoint {
  t_ms: number;
  value: number;
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

export interface TrustReport {
  green_s: number;
  amber_s: number;
  red_s: number;
  causes: [string, number][];
}

export interface UndoCheckIn {
  unit_id?: string;
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

export interface UnitStartForm {
  north_m: number;
  east_m: number;
  down_m?: number;
  heading_rad?: number;
  std_m?: number;
  heading_std_rad?: number;
}

export interface UnitTarget {
  unit_id: string;
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

export interface UserAnswer {
  username: string;
  role: string;
  created_ms: number;
  sessions: number;
}

export interface UserChange {
  password?: string | null;
  role?: "viewer" | "commander" | "administrator" | null;
}

export interface WornSensorView {
  name: string;
  place: string;
  place_recognised: boolean;
  mount: string;
  model: string;
}
