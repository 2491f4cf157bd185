/** Keeps a picture as the station describes it: connection, messages, snapshots on a gap, time. */
import { batch } from "@preact/signals";
import type { Message } from "../wire";
import { t } from "../language/translate";
import { LocalClock, StationClock } from "./clock";
import { Connection } from "./connection";
import { guarded } from "./faults";
import { Picture } from "./picture";
import { apply, type State } from "./state";

const CLOCK_STEP_MS = 500;

export class Session {
  readonly picture = new Picture();
  private readonly clock = new StationClock();
  private readonly local = new LocalClock();
  private connection: Connection | null = null;
  private timer = 0;
  private state: State | null = null;
  private asked = false;

  /** `onRefused`: the station refuses this picture, or has ended it. */
  constructor(
    private path: string,
    private readonly onRefused: (code: number) => void,
  ) {
    this.open();
  }

  /** Also after a close, or for another address of the picture: until the station is received, the
   * picture counts as old. */
  open(path = this.path): void {
    this.close();
    this.path = path;
    this.picture.link.value = { kind: "connecting" };
    this.connection = new Connection(socketUrl(this.path), {
      message: (text) => this.hearGuarded(text),
      up: () => undefined, // up means a picture: see hear
      down: () => this.lose(),
      refused: this.onRefused,
    });
    this.timer = window.setInterval(() => this.tick(), CLOCK_STEP_MS);
  }

  close(): void {
    window.clearInterval(this.timer);
    this.connection?.close();
    this.asked = false;
  }

  /** A failing message affects no other: its content comes with the next snapshot. */
  private hearGuarded(text: string): void {
    const heard = guarded(t("frame.message"), () => this.hear(JSON.parse(text) as Message));
    if (!heard) this.askOnce();
  }

  private hear(message: Message): void {
    const { state, missed } = apply(this.state, message);
    if (missed) {
      this.askOnce();
      return;
    }
    if (message.type === "snapshot") this.asked = false;
    this.state = state;
    if (state === null) return;
    if (message.type !== "trail") this.setClock(state);
    batch(() => {
      if (this.picture.link.peek().kind !== "up") this.picture.link.value = { kind: "up" };
      this.picture.show(state);
      // Everything that shows an age renders with the clock, so deltas do not drive it.
      if (message.type === "snapshot") this.tick(true);
    });
  }

  private askOnce(): void {
    if (!this.asked) this.connection?.askForSnapshot();
    this.asked = true;
  }

  private setClock({ replay, now_ms }: State): void {
    const speed = replay === null ? 1 : replay.playing && !replay.seeking ? replay.speed : 0;
    this.clock.set(now_ms, this.local.now(), speed);
  }

  private lose(): void {
    this.asked = false;
    if (this.picture.link.peek().kind === "down") return;
    this.picture.link.value = { kind: "down", sinceMs: performance.now() };
  }

  private tick(whole = false): void {
    if (this.state === null) return;
    const nowMs = this.clock.now(this.local.now());
    batch(() => {
      this.picture.nowMs.value = nowMs;
      this.picture.catchUp(whole);
    });
  }
}

function socketUrl(path: string): string {
  const scheme = location.protocol === "https:" ? "wss:" : "ws:";
  return `${scheme}//${location.host}${path}?deltas=fields`;
}
