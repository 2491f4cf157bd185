/** Station time between two messages: the last it said, carried on by the console's own clock. */

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
