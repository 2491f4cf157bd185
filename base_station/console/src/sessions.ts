/** The logged-in user, the live picture, and the open replay. */
import { batch, computed, effect, signal } from "@preact/signals";
import { t } from "./language/translate";
import * as api from "./api";
import { ApiError, isUnanswered } from "./http";
import { arrivalSoundNotice, ticketOf, withoutTicket } from "./live/loginTransfer";
import { NOT_LOGGED_IN } from "./live/connection";
import { watchOver } from "./live/failover";
import { Session } from "./live/session";
import { followUp } from "./live/unanswered";
import { confirmDone, notice, reset } from "./uiState";
import { keepBaseMap } from "./plan/baseMap";
import { putDown } from "./plan/tools";
import { soundBlocked, soundOn } from "./sound";

export interface Replay {
  id: string;
  session: Session;
  incident: api.Incident;
}

export const user = signal<api.Me | null>(null);
/** The station has ended this login: open work waits, hidden, for the same user. */
export const waiting = signal(false);
/** The page was opened while its station did not answer. */
export const stationAway = signal(false);
export const live = signal<Session | null>(null);
export const replay = signal<Replay | null>(null);

/** The picture on the screen: that of the open replay, otherwise the live one. */
export const picture = computed(() => (replay.value?.session ?? live.value)?.picture ?? null);
export const isPast = computed(() => picture.value !== null && picture.value.replay.value !== null);
/** Whether there is a live picture behind the replay. */
export const besideLive = computed(() => replay.value?.session !== live.value);
/** Whether this station leads; of two, things are changed only there.  One that reads its log does not
 * yet. */
const leads = computed(() => {
  const health = live.value?.picture.health.value ?? null;
  const standby = health?.standby ?? null;
  return (standby === null || standby.role === "active") && (health?.reading ?? null) === null;
});
/** A viewer, a replay and a standby are read-only. */
export const mayAct = computed(
  () => user.value !== null && user.value.role !== "viewer" && !isPast.value && leads.value,
);

/** The shown one of several open incidents: requests about an incident or its site name it. */
export function namedIncident(): string | undefined {
  const shown = live.peek()?.picture;
  if (shown === undefined || shown.choices.peek().length === 0) return undefined;
  return shown.incident.peek()?.incident_id;
}

/** Shows the console of the user who is logged in or transferred with a ticket; without one the login
 * form stays. */
export async function resume(): Promise<void> {
  const ticket = ticketOf(location.hash);
  if (ticket !== "") history.replaceState(null, "", withoutTicket(location.hash));
  try {
    const me = await inTime(api.me()).catch((error) =>
      ticket === "" ? Promise.reject(error) : api.loginWithTicket(ticket),
    );
    stationAway.value = false;
    if (me.must_change_password) return; // the login form asks for it
    begin(me);
    if (ticket !== "" && soundOn.peek() && soundBlocked.peek()) {
      notice.value = arrivalSoundNotice(location.hash);
    }
  } catch (error) {
    user.value = null;
    stationAway.value = isUnanswered(error);
  }
}

const AWAY_AFTER_MS = 8_000;

/** A station that hangs counts as away. */
function inTime<T>(work: Promise<T>): Promise<T> {
  const late = new Promise<never>((_, reject) =>
    setTimeout(() => reject(new ApiError(t("connection.unreachable"), 0)), AWAY_AFTER_MS),
  );
  return Promise.race([work, late]);
}

export function begin(me: api.Me): void {
  if (user.peek()?.username !== me.username) forget();
  batch(() => {
    user.value = me;
    waiting.value = false;
    if (live.value === null) live.value = new Session(api.LIVE_PATH, loginEnded);
    else live.value.open();
  });
  if (replay.value !== null && besideLive.value) void replayOn(replay.value);
  if (live.value === null) return;
  const stops = [watchOver(live.value, (url) => location.assign(url)), keepBaseMap()];
  stopWatching = () => stops.forEach((stop) => stop());
}

let stopWatching: () => void = () => undefined;

/** The station has closed the view; without a message it would look like a fault. */
function loginEnded(): void {
  wait();
  notice.value = t("login.ended");
}

export async function leave(): Promise<void> {
  stopReplay();
  live.peek()?.close();
  await attempt(api.logout());
  forget();
}

export async function watchReplay(incident: api.Incident): Promise<void> {
  const started = await attempt(api.startReplay(incident.incident_id));
  if (started === null) return;
  stopReplay();
  const session = new Session(api.replayPath(started.replay_id), (code) =>
    code === NOT_LOGGED_IN ? loginEnded() : replayEnded(),
  );
  replay.value = { id: started.replay_id, session, incident };
  reset();
}

export function stopReplay(): void {
  const watched = replay.peek();
  if (watched === null || watched.session === live.peek()) return;
  watched.session.close();
  replay.value = adopted;
  reset();
  // it ends by itself with its last viewer
  void steered.then(() => api.endReplay(watched.id)).catch(() => undefined);
}

let steered: Promise<unknown> = Promise.resolve();

/** Sent after the previous request: simultaneous requests may arrive in any order, and the last one of
 * the user must apply. */
export function steer({ id }: Replay, change: api.ReplayChange): void {
  steered = steered.then(() => attempt(api.changeReplay(id, change)));
}

/** Time of the replay when the login ended; the station has ended the replay if that was a while ago. */
async function replayOn(before: Replay): Promise<void> {
  const id = await attempt(replayAt(before));
  if (replay.peek() !== before) return;
  if (id === null) {
    replay.value = adopted;
    return;
  }
  before.session.open(api.replayPath(id));
  replay.value = { ...before, id };
}

/** The id of a replay of the same incident that continues from the time on the screen. */
async function replayAt({ id, session, incident }: Replay): Promise<string> {
  const shown = session.picture.replay.peek();
  const place =
    shown === null ? {} : { at_ms: shown.at_ms, speed: shown.speed, playing: shown.playing };
  try {
    await api.changeReplay(id, place);
    return id;
  } catch (error) {
    if (!(error instanceof ApiError && error.status === 404)) throw error;
  }
  const { replay_id } = await api.startReplay(incident.incident_id);
  await api.changeReplay(replay_id, place);
  return replay_id;
}

/** The result, or null with the reason shown to the person. */
export async function attempt<T>(work: Promise<T>): Promise<T | null> {
  try {
    return await work;
  } catch (error) {
    if (error instanceof ApiError && error.status === 401) wait();
    notice.value = error instanceof Error ? error.message : String(error);
    if (error instanceof ApiError && error.key !== null) void resolve(error.key, notice.value);
    return null;
  }
}

/** The notice shows the result that the station reports. */
function resolve(key: string, said: string): Promise<void> {
  let latest = said;
  return followUp(key, {
    ask: api.carriedOut,
    isHeard: () => live.peek()?.picture.link.peek().kind === "up",
    say: (sentence) => {
      if (notice.peek() === latest) notice.value = latest = sentence;
    },
    wait: (ms) => new Promise((done) => setTimeout(done, ms)),
    nowMs: () => performance.now(),
  });
}

/** Hidden behind the login form until the same user is back: the session has ended. */
function wait(): void {
  stopWatching();
  replay.peek()?.session.close();
  live.peek()?.close();
  waiting.value = user.peek() !== null;
}

/** Clears all data of the previous user. */
function forget(): void {
  wait();
  live.value = null;
  replay.value = adopted = null;
  user.value = null;
  waiting.value = false;
  putDown();
  reset();
}

function replayEnded(): void {
  replay.peek()?.session.close();
  replay.value = adopted;
  confirmDone(t("past.ended"));
}

/** `muster base replay` shows the past in place of the live picture. */
export const liveIsPast = computed(() => live.value !== null && live.value.picture.replay.value !== null);

/** The replay that such a station was started for: there is no live picture. */
let adopted: Replay | null = null;

effect(() => {
  if (liveIsPast.value && live.value !== null) void adopt(live.value);
});

effect(() => {
  const isHeard = live.value?.picture.link.value.kind === "up";
  if (isHeard && notice.peek() === t("connection.unreachable")) notice.value = null;
});

async function adopt(session: Session): Promise<void> {
  const running = ((await attempt(api.replays())) ?? []).find((one) => one.begun_by === "");
  if (running === undefined) return;
  const incident = await attempt(api.incident(running.incident_id));
  if (incident === null || live.peek() !== session) return;
  replay.value = adopted = { id: running.replay_id, session, incident };
}
