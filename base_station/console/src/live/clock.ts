/** Station time between two messages: the last received, advanced by the console's own clock. */

export class StationClock {
  private stationMs = 0;
  private localMs = 0;
  private speed = 1;

  /** `speed`: station seconds a second; 0 in a paused replay. */
  set(stationMs: number, localMs: number, speed: number): void {
    this.stationMs = stationMs;
    this.localMs = localMs;
    this.speed = speed;
  }

  now(localMs: number): number {
    return this.stationMs + (localMs - this.localMs) * this.speed;
  }
}

/** Larger than the difference of two clocks of one machine between two readings. */
const SLEPT_MS = 5_000;

/** The console's own clock.  `performance.now` never goes back, but on many machines it stops during
 * sleep; a sleep is detected by the wall clock. */
export class LocalClock {
  private lookedMs: number;
  private dayMs: number;
  private sleptMs = 0;

  constructor(
    private readonly steady: () => number = () => performance.now(),
    private readonly day: () => number = () => Date.now(),
  ) {
    this.lookedMs = steady();
    this.dayMs = day();
  }

  now(): number {
    const [steadyMs, dayMs] = [this.steady(), this.day()];
    const aheadMs = dayMs - this.dayMs - (steadyMs - this.lookedMs);
    if (aheadMs > SLEPT_MS) this.sleptMs += aheadMs;
    [this.lookedMs, this.dayMs] = [steadyMs, dayMs];
    return steadyMs + this.sleptMs;
  }
}
