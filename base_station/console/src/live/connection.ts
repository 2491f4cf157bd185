/** A WebSocket that reconnects automatically.  It reports messages and its state, and confirms to the
 * station what was shown. */
import { Pacing, SCREEN, type Screen } from "./pacing";

export interface ConnectionEvents {
  message(text: string): void;
  up(): void;
  down(retryInMs: number): void;
  refused(code: number): void;
}

/** Functions of the browser in use; tests replace them. */
export interface Surroundings extends Screen {
  open(url: string): WebSocket;
  cancel(timer: unknown): void;
  random(): number;
}

export const BROWSER: Surroundings = {
  ...SCREEN,
  open: (url) => new WebSocket(url),
  cancel: (timer) => clearTimeout(timer as number),
  random: () => Math.random(),
};

const FIRST_RETRY_MS = 300;
const LONGEST_RETRY_MS = 5000;
/** After this much silence the station is asked for a snapshot; after as much again the link is
 * dead, even where the socket has not noticed. */
export const SILENCE_MS = 2500;
/** Time limit of the first snapshot, equal to that of the station (base_station/api/routes/live.py).
 * With an earlier retry it would never arrive over a slow link. */
export const PICTURE_MS = 20_000;
/** Codes with which the station ends a connection for good (base_station/api/routes/live.py). */
export const NOT_LOGGED_IN = 4401;
export const NOT_FOUND = 4404;

/** How long to wait before try number `attempt` (from 0), spread so that a hundred consoles do not
 * return in the same instant. */
export function retryDelayMs(attempt: number, random: number): number {
  const longest = Math.min(FIRST_RETRY_MS * 2 ** attempt, LONGEST_RETRY_MS);
  return Math.round(longest * (0.5 + 0.5 * random));
}

export class Connection {
  private pacing: Pacing | null = null;
  private socket: WebSocket | null = null;
  private retry: unknown = null;
  private watchdog: unknown = null;
  private attempt = 0;
  private closed = false;

  constructor(
    private readonly url: string,
    private readonly events: ConnectionEvents,
    private readonly around: Surroundings = BROWSER,
  ) {
    this.connect();
  }

  /** Requests a snapshot. */
  askForSnapshot(): void {
    if (this.socket?.readyState === 1) this.socket.send('{"type":"snapshot"}');
  }

  close(): void {
    this.closed = true;
    this.around.cancel(this.retry);
    this.drop();
  }

  private connect(): void {
    const socket = this.around.open(this.url);
    this.socket = socket;
    const pacing = new Pacing((count) => {
      socket.send(JSON.stringify({ type: "shown", count }));
      this.listenForSilence();
    }, this.around);
    this.pacing = pacing;
    this.listenForSilence();
    socket.onopen = () => {
      this.watch(PICTURE_MS, () => this.lost());
      this.events.up();
    };
    socket.onmessage = (event: MessageEvent<string>) => {
      this.attempt = 0;
      this.around.cancel(this.watchdog); // the station waits for this page now
      pacing.take(() => this.events.message(event.data));
    };
    socket.onclose = (event) => this.ended(event.code);
  }

  private listenForSilence(): void {
    this.watch(SILENCE_MS, () => {
      this.askForSnapshot();
      this.watch(SILENCE_MS, () => this.lost());
    });
  }

  private watch(silenceMs: number, then: () => void): void {
    this.around.cancel(this.watchdog);
    this.watchdog = this.around.later(then, silenceMs);
  }

  private ended(code: number): void {
    if (code !== NOT_LOGGED_IN && code !== NOT_FOUND) {
      this.lost();
      return;
    }
    this.close();
    this.events.refused(code);
  }

  private lost(): void {
    if (this.closed) return;
    this.drop();
    const delayMs = retryDelayMs(this.attempt++, this.around.random());
    this.events.down(delayMs);
    this.retry = this.around.later(() => this.connect(), delayMs);
  }

  private drop(): void {
    this.around.cancel(this.watchdog);
    this.pacing?.close();
    const socket = this.socket;
    this.socket = null;
    if (socket === null) return;
    socket.onopen = socket.onmessage = socket.onclose = null;
    socket.close();
  }
}
