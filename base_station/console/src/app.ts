/** What the whole page shares: who is logged in, which picture is shown, what is selected. */
import { computed, signal } from "@preact/signals";
import * as api from "./api";
import { Session } from "./live/session";

export const user = signal<api.Me | null>(null);
export const live = signal<Session | null>(null);
export const replay = signal<{ id: string; session: Session; incident: api.Incident } | null>(null);

/** The picture on the screen: the replay while there is one, else what is live. */
export const picture = computed(() => (replay.value?.session ?? live.value)?.picture ?? null);

export const mayCommand = computed(() => user.value !== null && user.value.role !== "viewer");

export const selectedUnit = signal<string | null>(null);
/** Counts up when somebody asks to see the selected unit on the plan. */
export const centring = signal(0);
export type FloorChoice = number | "all";
export const floor = signal<FloorChoice>("all");

export type DialogName = "incidents" | "people" | "units" | "health";
export const dialog = signal<DialogName | null>(null);
/** The unit that the units dialog begins with. */
export const dialogUnit = signal<string | null>(null);
export const notice = signal<string | null>(null);

export function select(unitId: string): void {
  selectedUnit.value = unitId;
  const at = picture.peek()?.unit(unitId)?.peek().position?.floor ?? null;
  if (at !== null && floor.peek() !== "all") floor.value = at;
  centring.value += 1;
}

export function openDialog(name: DialogName, unitId: string | null = null): void {
  dialogUnit.value = unitId;
  dialog.value = name;
}

/** Show the console of whoever is logged in; without anyone the login form stays. */
export async function resume(): Promise<void> {
  try {
    begin(await api.me());
  } catch {
    user.value = null;
  }
}

export function begin(me: api.Me): void {
  user.value = me;
  live.value ??= new Session(api.LIVE_PATH, forget);
}

/** Back to the login form: the station knows nobody here any more. */
function forget(): void {
  stopReplay();
  live.peek()?.close();
  live.value = null;
  dialog.value = null;
  user.value = null;
}

export async function leave(): Promise<void> {
  stopReplay();
  await attempt(api.logout());
  forget();
}

export async function watchReplay(incident: api.Incident): Promise<void> {
  const started = await attempt(api.startReplay(incident.incident_id));
  if (started === null) return;
  stopReplay();
  const session = new Session(api.replayPath(started.replay_id), replayEnded);
  replay.value = { id: started.replay_id, session, incident };
  selectedUnit.value = null;
  dialog.value = null;
}

function replayEnded(): void {
  replay.peek()?.session.close();
  replay.value = null;
  notice.value = "The station has ended this replay.";
}

export function stopReplay(): void {
  const watched = replay.peek();
  if (watched === null) return;
  watched.session.close();
  replay.value = null;
  selectedUnit.value = null;
  void api.endReplay(watched.id).catch(() => undefined); // it ends by itself with its last viewer
}

/** The result, or null with the reason shown to the person. */
export async function attempt<T>(work: Promise<T>): Promise<T | null> {
  try {
    return await work;
  } catch (error) {
    if (error instanceof api.ApiError && error.status === 401) forget();
    notice.value = error instanceof Error ? error.message : String(error);
    return null;
  }
}
