/** State of the user interface: chosen unit and floor, open dialog, last notice. */
import { signal } from "@preact/signals";
import type { AlarmView } from "./wire";

export const selectedUnit = signal<string | null>(null);
/** Counts up with each request to show the selected unit on the plan. */
export const centring = signal(0);

export type FloorChoice = number | "all";
export const floor = signal<FloorChoice>("all");

export type DialogName =
  | "incidents"
  | "assessment"
  | "rehearsal"
  | "people"
  | "units"
  | "site"
  | "health"
  | "flaws"
  | "roll_call"
  | "account"
  | "display"
  | "board"
  | "users"
  | "audit"
  | "enrolments"
  | "evacuate"
  | "par_request"
  | "locate"
  | "text"
  | "timeline"
  | "alarm_reason"
  | "alarms"
  | "resolve"
  | "dispatch"
  | "imports";
export const dialog = signal<DialogName | null>(null);
/** The unit of the dialog, if it has one. */
export const dialogUnit = signal<string | null>(null);

/** The alarms whose reason the dialog asks for. */
export const resolving = signal<readonly AlarmView[]>([]);

/** Number of the dispatch that the dialog is about. */
export const dialogDispatch = signal<string | null>(null);

interface NamedIncident {
  incident_id: string;
  name: string;
}
/** The incident that is assessed. */
export const assessed = signal<NamedIncident | null>(null);
/** The incident over which thresholds are rehearsed. */
export const rehearsed = signal<NamedIncident | null>(null);
/** The incident whose imports are listed. */
export const withImports = signal<NamedIncident | null>(null);

/** An error, or what the user must not miss: it stays until it is read. */
export const notice = signal<string | null>(null);

const SEEN_MS = 4_000;
const READ_MS_PER_LETTER = 80;
let passing: string | null = null;
let timer: ReturnType<typeof setTimeout> | undefined;

/** A notice that confirms: it goes after the time that it takes to read it, or when a dialog opens. */
export function confirmDone(text: string): void {
  notice.value = passing = text;
  clearTimeout(timer);
  timer = setTimeout(endPassing, SEEN_MS + READ_MS_PER_LETTER * text.length);
}

function endPassing(): void {
  if (notice.peek() === passing) notice.value = null;
  passing = null;
}

/** Visible pane of a small screen; a large one shows both. */
export type Pane = "people" | "plan";
export const pane = signal<Pane>("people");

/** Show a unit on the plan; `on` is the floor where it is, as far as that is known. */
export function select(unitId: string, on: number | null): void {
  selectedUnit.value = unitId;
  if (on !== null && floor.peek() !== "all") floor.value = on;
  centring.value += 1;
}

/** The same, and changes to the plan on a small screen. */
export function find(unitId: string, on: number | null): void {
  select(unitId, on);
  pane.value = "plan";
}

export function openDialog(name: DialogName, unitId: string | null = null): void {
  endPassing();
  dialogUnit.value = unitId;
  dialog.value = name;
}

export function openResolve(alarms: readonly AlarmView[]): void {
  resolving.value = alarms;
  openDialog("resolve");
}

export function openDispatch(number: string): void {
  dialogDispatch.value = number;
  openDialog("dispatch");
}

export function assess(incident: NamedIncident): void {
  assessed.value = incident;
  openDialog("assessment");
}

export function openRehearsal(incident: NamedIncident): void {
  rehearsed.value = incident;
  openDialog("rehearsal");
}

export function openImports(incident: NamedIncident): void {
  withImports.value = incident;
  openDialog("imports");
}

/** As at the beginning, but for the floor. */
export function reset(): void {
  selectedUnit.value = null;
  dialog.value = null;
}
