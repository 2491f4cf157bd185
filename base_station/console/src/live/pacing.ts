/** Flow control of the live picture: the console confirms what was shown, and the station sends the
 * changes since then as one message.  A slow page shows updates less often but never outdated ones, and
 * keeps time for input. */
import { noteFrame } from "./frameCost";

/** Functions of the browser in use; tests replace them. */
export interface Screen {
  nowMs(): number;
  /** Called when the current drawing is on the screen; that drawing took `drawnMs`. */
  afterFrame(action: (drawnMs: number) => void): void;
  later(action: () => void, delayMs: number): unknown;
}

/** A hidden page has no animation frames, and still sounds alarms. */
const LONGEST_FRAME_MS = 500;
const LONGEST_REST_MS = 200;

export const SCREEN: Screen = {
  nowMs: () => performance.now(),
  afterFrame: (action) => {
    if (document.visibilityState === "hidden") {
      action(0);
      return;
    }
    let waits = true;
    const once = (drawnMs: number) => {
      if (waits) action(drawnMs);
      waits = false;
    };
    requestAnimationFrame(() => {
      const beganMs = performance.now();
      setTimeout(() => once(performance.now() - beganMs), 0);
    });
    setTimeout(() => once(0), LONGEST_FRAME_MS);
  },
  later: (action, delayMs) => setTimeout(action, delayMs),
};

/** Of one connection. */
export class Pacing {
  private count = 0;
  private confirmed = 0;
  private workMs = 0; // since the last frame
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
    this.workMs += this.screen.nowMs() - beganMs;
    this.follow(beganMs);
  }

  close(): void {
    this.isOver = true;
  }

  /** The pause is as long as the page's own work for what came: half of the time is left for input.  Waiting and
   * other work do not count, and the longest pause is short beside the second that the picture may be old. */
  private follow(beganMs: number): void {
    if (this.isBusy) return;
    this.isBusy = true;
    this.screen.afterFrame((drawnMs) => {
      const shown = this.count;
      noteFrame(this.screen.nowMs() - beganMs);
      const restMs = Math.min(this.workMs + drawnMs, LONGEST_REST_MS);
      this.workMs = 0;
      this.screen.later(() => this.rested(shown), restMs);
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
