/** The part of the station's REST API that the console uses. */
import type * as answers from "./answers";
import type { Assessment } from "./assessment";
import type { Target } from "./live/commands";
import { BASE, act, call, file, id, page, fetchAllPages } from "./http";
import type { AlarmView, AnchorView, BeaconView, CommandView, PinView } from "./wire";

/** Each may do what those before it may. */
export const ROLES = ["viewer", "commander", "administrator"] as const;
export type Role = (typeof ROLES)[number];

/** The document of the API has the role as a string. */
type WithRole<Answer> = Omit<Answer, "role"> & { role: Role };
export type Me = WithRole<answers.Me>;
export type User = WithRole<answers.UserAnswer>;
export type Token = WithRole<answers.Token>;
export type NewToken = Required<answers.NewToken>;
export type AuditEntry = answers.AuditEntryAnswer;
export type Person = answers.PersonView;
export type PlanDraft = answers.PlanDraft;
export type DrawnPicture = answers.DrawnPictureAnswer;
export type PeopleImport = answers.PeopleImport;
export type UnitDetails = answers.UnitAnswer;
export type EnrolledUnit = answers.EnrolledUnit;
export type ShownEnrolment = answers.ShownEnrolment;
export type Incident = answers.IncidentAnswer;
export type OfferedDispatch = answers.OfferedDispatch;
export type PastAlarm = answers.PastAlarm;
/** Obstacles that the closing of an incident names. */
export type Despite = Required<answers.ClosingForm>;
/** PAR interval and work limit. */
export type Times = answers.Times;
export type RunningReplay = answers.Replay;
export type BaseMap = answers.BaseMapAnswer;
export type LatLon = BaseMap["upper_left"];
export type ReplayChange = answers.ReplayChange;
export type Forgetting = answers.Progress;
export type ExportFormat = answers.Format;
export type NewPin = Required<Omit<answers.PinForm, "heading_rad" | "heading_std_rad">>;
export type Start = Required<Omit<answers.StartForm, "heading_std_rad">>;
export type TrailsAnswer = answers.Trails;
/** Outcome of a request without an answer; 404 if the station has not carried it out. */
export type CarriedOut = answers.CarriedOut;
export type Route = answers.RouteAnswer;
export type Guide = answers.GuideAnswer;
export type CommandKind = Exclude<answers.Kind, "set_position_rate">;

/** Parts of the API that a token can be for (base_station/api/authentication.py). */
export const SCOPES = [
  "accountability",
  "alarms",
  "assignments",
  "audit",
  "commands",
  "dispatch",
  "enrolments",
  "exports",
  "forgetting",
  "health",
  "incidents",
  "live",
  "people",
  "pins",
  "radio",
  "recordings",
  "replays",
  "samples",
  "site",
  "standby",
  "tokens",
  "tracks",
  "units",
  "users",
] as const satisfies readonly answers.Scope[];

export const login = (username: string, password: string) =>
  call<Me>("POST", "/login", { username, password });
/** Log in with a ticket of the other station's console. */
export const loginWithTicket = (ticket: string) => call<Me>("POST", "/login/hand-over", { ticket });
export const createLoginTicket = () => call<{ ticket: string }>("POST", "/hand-over");
export const logout = () => call<void>("POST", "/logout");
export const me = () => call<Me>("GET", "/me");

export const people = () => call<Person[]>("GET", "/people");
export const addPerson = (person: { name: string; crew: string; role: string }) =>
  act<Person>("POST", "/people", person);
export const changePerson = (personId: string, person: Omit<Person, "person_id" | "photo_url">) =>
  call<Person>("PUT", `/people/${id(personId)}`, person);
export const setPhoto = (personId: string, photo: Blob) =>
  call<void>("PUT", `/people/${id(personId)}/photo`, photo);

/** All of them, or none; a preview changes nothing. */
export const importPeople = (csv: Blob, preview: boolean) =>
  call<PeopleImport>("POST", `/people/import?preview=${preview}`, new Blob([csv], { type: "text/csv" }));

export const units = () => call<UnitDetails[]>("GET", "/units");
export const forgettings = () => call<Forgetting[]>("GET", "/forgettings");
export const forgetPerson = (personId: string, name: string) =>
  call<Forgetting>("POST", `/people/${id(personId)}/forget`, { name });
export const forgetIncident = (incidentId: string, name: string) =>
  call<Forgetting>("POST", `/incidents/${id(incidentId)}/forget`, { name });

/** Starts the transfer of a unit's raw recording: of an incident, or from a station time until now. */
export const fetchRecording = (
  unitId: string,
  wanted: { incident_id: string } | { from_ms: number },
) => call<object>("POST", "/recordings", { unit_id: unitId, ...wanted });
/** The received part is kept. */
export const stopRecording = (fetchId: string) =>
  call<void>("DELETE", `/recordings/${id(fetchId)}`);
export const registerUnit = (unitId: string, label: string) =>
  act<object>("POST", "/units", { unit_id: unitId, label });
export const enrolments = () => call<EnrolledUnit[]>("GET", "/enrolments");
/** Its private key is in the answer alone: it cannot be asked for again. */
export const enrol = (unitId: string, renew: boolean) =>
  call<ShownEnrolment>("POST", "/enrolments", { unit_id: unitId, renew });
/** The secret is in the answer alone, too. */
export const addUnitToken = (unitId: string) =>
  call<answers.UnitTokenSecret>("POST", `/units/${id(unitId)}/sample-tokens`, {});
export const assign = (unitId: string, personId: string) =>
  act<void>("POST", "/assignments", { unit_id: unitId, person_id: personId });
export const unassign = (unitId: string) => call<void>("DELETE", `/assignments/${id(unitId)}`);

export const incidents = (untilMs?: number, text = "") =>
  call<Incident[]>("GET", `/incidents${page(untilMs)}&text=${encodeURIComponent(text)}`);
export const incident = (incidentId: string) =>
  call<Incident>("GET", `/incidents/${id(incidentId)}`);
export const openIncident = (name: string, times: Partial<Times>, dispatchNumber?: string) => {
  const from = dispatchNumber === undefined ? {} : { dispatch_number: dispatchNumber };
  return act<Incident>("POST", "/incidents", { name, ...times, ...from });
};
/** While others are open. */
export const openBeside = (name: string, times: Partial<Times>) =>
  act<Incident>("POST", "/incidents", { name, ...times, beside_others: true });
/** From where they are. */
export const assignMembers = (incidentId: string, target: Target) =>
  act<object>("POST", `/incidents/${id(incidentId)}/members`, { target });
export const dispatches = () => call<OfferedDispatch[]>("GET", "/dispatch");
export const dismissDispatch = (number: string) =>
  act<void>("POST", "/dispatch/dismissals", { number });
/** As this station is configured. */
export const usualTimes = () => call<Times>("GET", "/accountability/usual");
export const setTimes = (incidentId: string, times: Times) =>
  call<void>("PUT", `/incidents/${id(incidentId)}/accountability`, times);
/** Over the alarms and the people inside that are named, and nothing else. */
export const closeIncident = (incidentId: string, despite: Despite) =>
  act<void>("POST", `/incidents/${id(incidentId)}/close`, despite);
export const incidentAlarms = (incidentId: string) =>
  fetchAllPages<PastAlarm>(`/incidents/${id(incidentId)}/alarms`, (alarm) => alarm.raised_ms);

export const exportFormats = () => call<ExportFormat[]>("GET", "/export-formats");
export const report = (incidentId: string, suffix: "html" | "pdf") =>
  file(`/incidents/${id(incidentId)}/report.${suffix}`);
export const wholeIncident = (incidentId: string, withRadio: boolean) =>
  file(`/incidents/${id(incidentId)}/incident.mcap${withRadio ? "?radio=true" : ""}`);
export const exported = (incidentId: string, format: string, kind: string) =>
  file(`/incidents/${id(incidentId)}/export/${id(format)}?kind=${kind}`);

/** Raised from then on, with their lives. */
export const alarms = (fromMs: number) =>
  fetchAllPages<answers.AlarmWithLife>("/alarms", (alarm) => alarm.raised_ms, `&from_ms=${fromMs}`);
/** Which raising of it is on the screen. */
export type SeenAlarm = Pick<AlarmView, "alarm_id" | "last_raised_ms">;
/** For the shown raising: the station refuses it for an alarm that was raised again since. */
export const acknowledge = ({ alarm_id, last_raised_ms }: SeenAlarm) =>
  act<void>("POST", `/alarms/${id(alarm_id)}/acknowledge`, { last_raised_ms });
export const resolve = (
  { alarm_id, last_raised_ms }: SeenAlarm,
  { reason, note }: { reason: answers.ResolutionReason; note: string },
) => act<void>("POST", `/alarms/${id(alarm_id)}/resolve`, { last_raised_ms, reason, note });

export const sendCommand = (kind: CommandKind, target: Target, text: string, incidentId?: string) =>
  act<CommandView>("POST", "/commands", { kind, target, text, incident_id: incidentId });
/** To a member: of the three nearest by way, or of one rescuer. */
export const routes = (unitId: string, rescuerId: string | null = null) =>
  call<Route[]>(
    "GET",
    `/units/${id(unitId)}/routes${rescuerId === null ? "" : `?rescuer_id=${id(rescuerId)}`}`,
  );
export const guides = () => call<Guide[]>("GET", "/guides");
/** The route is sent to the rescuer's unit, leg by leg. */
export const guide = (unitId: string, rescuerId: string) =>
  act<Guide>("POST", `/units/${id(unitId)}/guides`, { rescuer_id: rescuerId });
export const endGuide = (rescuerId: string) =>
  call<void>("DELETE", `/guides/${id(rescuerId)}`);

export const setPositionRate = (unitId: string, rateHz: number) =>
  act<CommandView>("POST", "/commands", {
    kind: "set_position_rate",
    target: { unit_id: unitId },
    position_rate_hz: rateHz,
  });
/** To one unit, or to all who have not answered. */
export const repeatCommand = (commandId: string, unitId: string | null = null) =>
  act<CommandView>("POST", `/commands/${id(commandId)}/repeat`, { unit_id: unitId });
/** The evacuation is over. */
export const giveAllClear = (commandId: string) =>
  act<CommandView>("POST", `/commands/${id(commandId)}/all-clear`, {});
/** Ends the signals of the units. */
export const stopCommand = (commandId: string) =>
  act<void>("POST", `/commands/${id(commandId)}/stop`, {});
export const confirmCommand = (commandId: string, unitId: string) =>
  act<void>("POST", `/commands/${id(commandId)}/confirm`, { unit_id: unitId });
export const undoConfirmCommand = (commandId: string, unitId: string) =>
  act<void>("POST", `/commands/${id(commandId)}/confirm/undo`, { unit_id: unitId });

/** PAR by radio; by the id it can be undone. */
export const checkIn = (target: Target, checkInId: string, incidentId?: string) =>
  act<void>("POST", "/check-ins", { target, check_in_id: checkInId, incident_id: incidentId });
/** Of one member, or of all whom it confirmed. */
export const undoCheckIn = (checkInId: string, unitId = "") =>
  act<void>("POST", `/check-ins/${id(checkInId)}/undo`, { unit_id: unitId });
export const setRest = (unitId: string, resting: boolean) =>
  act<void>("PUT", `/units/${id(unitId)}/rest`, { resting });

export const changeOwnPassword = (old_password: string, new_password: string) =>
  call<void>("POST", "/me/password", { old_password, new_password });
export const tokens = () => call<Token[]>("GET", "/tokens");
export const addToken = (token: NewToken) => call<{ token: string }>("POST", "/tokens", token);
export const removeToken = (tokenId: string) => call<void>("DELETE", `/tokens/${id(tokenId)}`);
export const users = () => call<User[]>("GET", "/users");
export const addUser = (username: string, password: string, role: Role) =>
  call<void>("POST", "/users", { username, password, role });
export const changeUser = (username: string, change: { password?: string; role?: Role }) =>
  call<void>("PUT", `/users/${id(username)}`, change);
export const removeUser = (username: string) => call<void>("DELETE", `/users/${id(username)}`);
export const endSessions = (username: string) =>
  call<void>("DELETE", `/users/${id(username)}/sessions`);
export const audit = (untilMs?: number) => call<AuditEntry[]>("GET", `/audit${page(untilMs)}`);

/** Omitted fields stay unchanged. */
export type MovedPin = Pick<NewPin, "unit_id" | "north_m" | "east_m"> & Partial<NewPin>;
export type MovedBeacon = Pick<BeaconView, "beacon_id" | "north_m" | "east_m"> &
  Partial<Omit<BeaconView, "seen_ms">>;

export const setPin = (pin: NewPin) => act<PinView>("POST", "/pins", pin);
export const movePin = (pinId: string, pin: MovedPin) =>
  call<PinView>("PUT", `/pins/${id(pinId)}`, pin);
export const removePin = (pinId: string) => call<void>("DELETE", `/pins/${id(pinId)}`);
export const startTogether = (start: Start) => act<PinView[]>("POST", "/pins/start", start);
export const setMeeting = (meeting: Required<answers.MeetingForm>) => act<PinView>("POST", "/pins/meeting", meeting);
export const placeBeacon = (beacon: MovedBeacon, incidentId?: string) => {
  const { beacon_id, ...place } = beacon;
  return call<BeaconView>("PUT", `/beacons/${id(beacon_id)}`, { ...place, incident_id: incidentId });
};
export const removeBeacon = (beaconId: string) =>
  call<void>("DELETE", `/beacons/${id(beaconId)}`);

export const trails = (incidentId: string, kind: string) =>
  call<TrailsAnswer>("GET", `/incidents/${id(incidentId)}/trails?kind=${kind}`);

/** Of a span of at most a day; the station's time, as the console has it, is no whole number of milliseconds. */
export const timeline = (unitId: string, fromMs: number, untilMs: number, buckets: number) => {
  const [from, until] = [Math.round(fromMs), Math.round(untilMs)];
  return call<answers.TimelineAnswer>(
    "GET",
    `/units/${id(unitId)}/timeline?from_ms=${from}&until_ms=${until}&buckets=${buckets}`,
  );
};

/** Values about the time of an alarm, and the threshold that one of them crossed. */
export const alarmExplanation = (alarmId: string) =>
  call<answers.AlarmExplanationAnswer>("GET", `/alarms/${id(alarmId)}/explanation`);

/** Takes some seconds: the smoothed trails are computed for it. */
export const assessment = (incidentId: string) =>
  call<Assessment>("GET", `/incidents/${id(incidentId)}/assessment`);

export const thresholds = (incidentId: string) =>
  call<answers.ThresholdAnswer[]>("GET", `/incidents/${id(incidentId)}/thresholds`);

/** Takes some seconds for each hour of wear.  `changes`: "no-motion.alarm_s=25"; `sweep`: "no-motion.alarm_s=15:60:5". */
export const rehearsal = (incidentId: string, changes: readonly string[], sweep: string) =>
  call<answers.RehearsalAnswer>(
    "GET",
    `/incidents/${id(incidentId)}/rehearsal?sweep=${id(sweep)}${changes.map((one) => `&change=${id(one)}`).join("")}`,
  );

export const carriedOut = (key: string) => call<CarriedOut>("GET", `/idempotency-keys/${id(key)}`);

export const takeOver = () => call<void>("POST", "/standby/take-over");

function onSiteOf(incidentId?: string): string {
  return incidentId === undefined ? "" : `?incident_id=${id(incidentId)}`;
}

/** The file is not kept; `name` is for the plan. */
export const draftPlan = (file: File, name: string, page: number, unit: string) =>
  call<PlanDraft>(
    "POST",
    `/site/drafts?page=${page}&name=${id(name)}${unit === "" ? "" : `&unit=${unit}`}`,
    new Blob([file], { type: "application/octet-stream" }),
  );
export const setPlan = (plan: object, incidentId?: string) =>
  call<void>("PUT", `/site/plan${onSiteOf(incidentId)}`, plan);
export const baseMap = () => call<BaseMap | null>("GET", "/site/base-map");
export const setBaseMap = (image: Blob, world: readonly number[], crs: string) =>
  call<BaseMap>(
    "PUT",
    `/site/base-map?crs=${id(crs)}${world.map((value) => `&world=${value}`).join("")}`,
    image,
  );
export const removeBaseMap = () => call<void>("DELETE", "/site/base-map");
export const setAnchor = (anchor: AnchorView, incidentId?: string) =>
  call<void>("PUT", `/site/anchor${onSiteOf(incidentId)}`, anchor);

export const replays = () => call<RunningReplay[]>("GET", "/replays");
export const startReplay = (incidentId: string) =>
  call<RunningReplay>("POST", "/replays", { incident_id: incidentId });
export const changeReplay = (replayId: string, change: ReplayChange) =>
  call<void>("POST", `/replays/${id(replayId)}`, change);
export const endReplay = (replayId: string) => call<void>("DELETE", `/replays/${id(replayId)}`);

export const radio = (incidentId: string) => call<answers.RadioAnswer>("GET", `/incidents/${id(incidentId)}/radio`);
/** The audio of a window, second for second; a player requests it in ranges. */
export const radioPath = (incidentId: string, channel: string, fromMs: number, lengthMs: number) =>
  `${BASE}/incidents/${id(incidentId)}/radio/${id(channel)}?from_ms=${fromMs}&length_ms=${lengthMs}`;

export const LIVE_PATH = `${BASE}/live`;
export const replayPath = (replayId: string) => `${BASE}/replays/${id(replayId)}/live`;
