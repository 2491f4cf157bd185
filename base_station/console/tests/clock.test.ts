import { beforeEach, describe, expect, it } from "vitest";
import { LocalClock, StationClock } from "../src/live/clock";

let steadyMs: number;
let dayMs: number;
let clock: LocalClock;

function pass(ms: number, ofTheDay = ms): void {
  steadyMs += ms;
  dayMs += ofTheDay;
}

beforeEach(() => {
  steadyMs = 100;
  dayMs = 1_795_255_608_000;
  clock = new LocalClock(
    () => steadyMs,
    () => dayMs,
  );
});

describe("LocalClock", () => {
  it("goes on with the steady one", () => {
    pass(700);
    expect(clock.now()).toBe(800);
    pass(60_000, 60_040);
    expect(clock.now()).toBe(60_800);
  });

  it("goes on while the machine sleeps and the steady one stands", () => {
    pass(400, 3_600_400);
    expect(clock.now()).toBe(3_600_500);
    pass(500);
    expect(clock.now()).toBe(3_601_000);
  });

  it("heeds no clock of the day that is set back", () => {
    pass(500, -7_200_000);
    expect(clock.now()).toBe(600);
    pass(500);
    expect(clock.now()).toBe(1_100);
  });
});

describe("StationClock", () => {
  it("carries on what the station said last, as fast as it goes there", () => {
    const station = new StationClock();
    station.set(10_000, 500, 4);
    expect(station.now(1_500)).toBe(14_000);
    station.set(20_000, 1_500, 0);
    expect(station.now(9_000)).toBe(20_000);
  });
});
