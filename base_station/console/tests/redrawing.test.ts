import { afterEach, beforeEach, expect, it, vi } from "vitest";
import { noteFrame } from "../src/live/frameCost";
import { atMostEvery, redrawMs } from "../src/plan/redrawing";

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

function drawing(takesMs: number) {
  const drawnMs: number[] = [];
  const redraw = atMostEvery(() => 200, () => {
    drawnMs.push(performance.now() - beganMs);
    vi.setSystemTime(Date.now() + takesMs);
    vi.advanceTimersByTime(takesMs);
  });
  const beganMs = performance.now();
  return { drawnMs, redraw };
}

it("draws once a period, however often it is asked", () => {
  const { drawnMs, redraw } = drawing(0);
  for (let i = 0; i < 100; i++) {
    redraw.ask();
    vi.advanceTimersByTime(10);
  }
  expect(drawnMs).toEqual([0, 200, 400, 600, 800, 1000]);
});

it("leaves a slow drawing four times its own time", () => {
  const { drawnMs, redraw } = drawing(100);
  redraw.ask();
  vi.advanceTimersByTime(0); // the drawing itself lets 100 ms pass
  redraw.ask();
  vi.advanceTimersByTime(399);
  expect(drawnMs).toHaveLength(1);
  vi.advanceTimersByTime(1);
  expect(drawnMs).toHaveLength(2);
});

it("draws no more once it is over", () => {
  const { drawnMs, redraw } = drawing(0);
  redraw.ask();
  redraw.cancel();
  vi.advanceTimersByTime(1000);
  expect(drawnMs).toEqual([]);
});

it("comes less often while the page is slow", () => {
  for (let i = 0; i < 100; i++) noteFrame(10); // whatever was noted before
  const often = redrawMs();
  for (let i = 0; i < 20; i++) noteFrame(150);
  expect(redrawMs()).toBeGreaterThan(2 * often);
  for (let i = 0; i < 20; i++) noteFrame(10);
  expect(redrawMs()).toBe(often);
});
