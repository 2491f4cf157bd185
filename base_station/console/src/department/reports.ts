/** Reports of the department, requested once a second, and the filters on them. */
import { effect, signal } from "@preact/signals";
import { ApiError, call, id, PAGE } from "../http";
import { t } from "../language/translate";
import * as api from "../api";
import type { DepartmentIncidentsView, DepartmentPeopleView, DepartmentView, StartedReplay } from "./answers";

const PERIOD_MS = 1000;
const SHUT_OUT = [401, 403];

/** Null: no user is logged in, or no report has arrived yet. */
export const overview = signal<DepartmentView | null>(null);
export const people = signal<DepartmentPeopleView | null>(null);
/** Results of the search; null: none was made, or none has arrived yet. */
export const foundIncidents = signal<DepartmentIncidentsView | null>(null);
/** Why what is shown is old; empty: it is current. */
export const problem = signal("");
export const isLoggedIn = signal(false);

/** Which people are shown; empty: all. */
export const search = signal("");
export const station = signal("");
export const skip = signal(0);
/** Which incidents are shown; empty: the open and the newest ones. */
export const incidentSearch = signal("");
export const incidentSkip = signal(0);

let timer: ReturnType<typeof setTimeout> | undefined;
let turn = 0;

/** Requests reports periodically while a user is logged in. */
export async function refresh(): Promise<void> {
  clearTimeout(timer);
  const mine = ++turn;
  try {
    const [all, some, found] = await Promise.all([
      call<DepartmentView>("GET", "/department"),
      call<DepartmentPeopleView>("GET", `/department/people${query()}`),
      wantedIncidents(),
    ]);
    if (mine !== turn) return; // somebody has asked for something else since
    [overview.value, people.value, foundIncidents.value] = [all, some, found.incidents];
    [problem.value, isLoggedIn.value] = [found.problem, true];
  } catch (error) {
    if (mine !== turn) return;
    if (error instanceof ApiError && SHUT_OUT.includes(error.status)) {
      forget();
      return;
    }
    isLoggedIn.value = overview.value !== null;
    problem.value = error instanceof Error ? error.message : t("connection.unreachable");
  }
  timer = setTimeout(() => void refresh(), PERIOD_MS);
}

function query(): string {
  const wanted = `search=${id(search.peek())}&station=${id(station.peek())}`;
  return `?${wanted}&skip=${skip.peek()}&limit=${PAGE}`;
}

interface Found {
  incidents: DepartmentIncidentsView | null;
  problem: string;
}

/** A search uses the database: while that is away, all else continues from memory. */
async function wantedIncidents(): Promise<Found> {
  const search = incidentSearch.peek().trim();
  if (search === "") return { incidents: null, problem: "" };
  const wanted = `search=${id(search)}&skip=${incidentSkip.peek()}&limit=${PAGE}`;
  try {
    const incidents = await call<DepartmentIncidentsView>("GET", `/department/incidents?${wanted}`);
    return { incidents, problem: "" };
  } catch (error) {
    if (!(error instanceof ApiError) || SHUT_OUT.includes(error.status)) throw error;
    return { incidents: foundIncidents.peek(), problem: error.message };
  }
}

export function searchIncidents(search: string, first = 0): void {
  [incidentSearch.value, incidentSkip.value] = [search, Math.max(0, first)];
  void refresh();
}

/** People of this station, or whose name has these words, from the first. */
export function want(changes: { search?: string; station?: string }): void {
  search.value = changes.search ?? search.value;
  station.value = changes.station ?? station.value;
  skip.value = 0;
  void refresh();
}

export function turnTo(first: number): void {
  skip.value = Math.max(0, first);
  void refresh();
}

export async function leave(): Promise<void> {
  await api.logout().catch(() => undefined);
  forget();
}

function forget(): void {
  clearTimeout(timer);
  turn += 1;
  [overview.value, people.value, isLoggedIn.value] = [null, null, false];
}

/** A past incident, shown from the department's archive. */
export const openArchived = (name: string, incidentId: string) =>
  call<StartedReplay>("POST", "/department/replays", { station: name, incident_id: incidentId });

effect(() => {
  const view = overview.value;
  document.title = view === null ? t("department.title") : `(${view.open_alarms}) ${t("department.title")}`;
});
