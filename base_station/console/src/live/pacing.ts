/** Flow control of the live picture: the console confirms what was shown, and the station sends the
 * changes since then as one message.  A slow page shows updates less often but never outdated ones, and
 * keeps time for input. */
import { noteFrame } from "./frameCost";

/** Functions of the browser in use; tests replace them. */
export interface Screen {
  nowMs(): number;
  /** Called when the current drawing is on the screen. */
  afterFrame(action: () => void): void;
  later(action: () => void, delayMs: number): unknown;
}

/** A hidden page has no animation frames, and still sounds alarms. */
const LONGEST_FRAME_MS = 500;
const LONGEST_REST_MS = 400;

export const SCREEN: Screen = {
  nowMs: () => performance.now(),
  afterFrame: (action) => {
    if (document.visibilityState === "hidden") {
      action();
      return;
    }
    let waits = true;
    const once = () => {
      if (waits) action();
      waits = false;
    };
    requestAnimationFrame(() => setTimeout(once, 0));
    setTimeout(once, LONGEST_FRAME_MS);
  },
  later: (action, delayMs) => setTimeout(action, delayMs),
};

/** Of one connection. */
export class Pacing {
  private count = 0;
  private confirmed = 0;
  private isBusy = false;
  private isOver = false;

  constructor(
    private readonly confirm: (count: number) => void,
    private readonly screen: Screen,
  ) {}

  /** A message has come; `show` shows it. */
  take(show: () => void): void {
    const beganMs = this.screen.nowMs();
    show();
    this.count += 1;
    this.follow(beganMs);
  }

  close(): void {
    this.isOver = true;
  }

  /** The pause is as long as the work before it: half of the time is left for input. */
  private follow(beganMs: number): void {
    if (this.isBusy) return;
    this.isBusy = true;
    this.screen.afterFrame(() => {
      const shown = this.count;
      const busyMs = this.screen.nowMs() - beganMs;
      noteFrame(busyMs);
      this.screen.later(() => this.rested(shown), Math.min(busyMs, LONGEST_REST_MS));
    });
  }

  private rested(shown: number): void {
    this.isBusy = false;
    if (this.isOver) return;
    this.confirmed = shown;
    this.confirm(shown);
    if (this.count > this.confirmed) this.follow(this.screen.nowMs());
  }
}
