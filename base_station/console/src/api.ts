/** The station's REST API, as far as the console uses it. */
import type { Target } from "./live/commands";
import type { AnchorView, CommandView } from "./wire";

export interface Me {
  username: string;
  role: "viewer" | "commander" | "administrator";
}

export interface Person {
  person_id: string;
  name: string;
  crew: string;
  role: string;
  photo_url: string | null;
}

export interface Incident {
  incident_id: string;
  name: string;
  opened_ms: number;
  closed_ms: number | null;
}

export interface PastAlarm {
  alarm_id: string;
  unit_id: string;
  priority: number;
  text: string;
  raised_ms: number;
}

export type CommandKind = "evacuate" | "par_request" | "text";

export interface RunningReplay {
  replay_id: string;
  incident_id: string;
}

export type ReplayChange = { playing?: boolean; speed?: number; at_ms?: number };

/** The station refused or could not be reached; the text is for a person. */
export class ApiError extends Error {
  constructor(
    message: string,
    readonly status: number,
  ) {
    super(message);
  }
}

const BASE = "/api/v1";

async function call<T>(method: string, path: string, body?: object | Blob): Promise<T> {
  const init: RequestInit = { method, credentials: "same-origin" };
  if (body instanceof Blob) init.body = body;
  else if (body !== undefined) {
    init.body = JSON.stringify(body);
    init.headers = { "content-type": "application/json" };
  }
  const response = await fetch(BASE + path, init).catch(() => {
    throw new ApiError("The station cannot be reached.", 0);
  });
  if (!response.ok) throw new ApiError(await reason(response), response.status);
  return response.status === 204 ? (undefined as T) : ((await response.json()) as T);
}

/** The sentence of a problem document (RFC 9457). */
async function reason(response: Response): Promise<string> {
  const body: unknown = await response.json().catch(() => null);
  const detail = (body as { detail?: unknown } | null)?.detail;
  return typeof detail === "string" ? detail : `The station answered ${response.status}.`;
}

const id = encodeURIComponent;

export const login = (username: string, password: string) =>
  call<Me>("POST", "/login", { username, password });
export const logout = () => call<void>("POST", "/logout");
export const me = () => call<Me>("GET", "/me");

export const people = () => call<Person[]>("GET", "/people");
export const addPerson = (person: { name: string; crew: string; role: string }) =>
  call<Person>("POST", "/people", person);
export const setPhoto = (personId: string, photo: Blob) =>
  call<void>("PUT", `/people/${id(personId)}/photo`, photo);

export const registerUnit = (unitId: string, label: string) =>
  call<object>("POST", "/units", { unit_id: unitId, label });
export const assign = (unitId: string, personId: string) =>
  call<void>("POST", "/assignments", { unit_id: unitId, person_id: personId });
export const unassign = (unitId: string) => call<void>("DELETE", `/assignments/${id(unitId)}`);

export const incidents = () => call<Incident[]>("GET", "/incidents");
export const incident = (incidentId: string) =>
  call<Incident>("GET", `/incidents/${id(incidentId)}`);
export const openIncident = (name: string) => call<Incident>("POST", "/incidents", { name });
export const closeIncident = (incidentId: string) =>
  call<void>("POST", `/incidents/${id(incidentId)}/close`);
export const incidentAlarms = (incidentId: string) =>
  call<PastAlarm[]>("GET", `/incidents/${id(incidentId)}/alarms`);

export const acknowledge = (alarmId: string) =>
  call<void>("POST", `/alarms/${id(alarmId)}/acknowledge`);
export const resolve = (alarmId: string) =>
  call<void>("POST", `/alarms/${id(alarmId)}/resolve`, {});

export const sendCommand = (kind: CommandKind, target: Target, text: string) =>
  call<CommandView>("POST", "/commands", { kind, target, text });
export const confirmCommand = (commandId: string, unitId: string) =>
  call<void>("POST", `/commands/${id(commandId)}/confirm`, { unit_id: unitId });

export const setPlan = (plan: object) => call<void>("PUT", "/site/plan", plan);
export const setAnchor = (anchor: AnchorView) => call<void>("PUT", "/site/anchor", anchor);

export const replays = () => call<RunningReplay[]>("GET", "/replays");
export const startReplay = (incidentId: string) =>
  call<RunningReplay>("POST", "/replays", { incident_id: incidentId });
export const changeReplay = (replayId: string, change: ReplayChange) =>
  call<void>("POST", `/replays/${id(replayId)}`, change);
export const endReplay = (replayId: string) => call<void>("DELETE", `/replays/${id(replayId)}`);

export const LIVE_PATH = `${BASE}/live`;
export const replayPath = (replayId: string) => `${BASE}/replays/${id(replayId)}/live`;
