import { describe, expect, it } from "vitest";
import { correction, isUnderstood, WINDOW_MS, windowAt } from "../src/live/radioSync";

describe("the audio of the radio beside a replay", () => {
  it("is asked for in windows that stay the same while it plays, and end with the incident", () => {
    const [start, end] = [1_000, 1_000 + 2.5 * WINDOW_MS];
    expect(windowAt(start, start, end)).toEqual({ fromMs: start, lengthMs: WINDOW_MS });
    expect(windowAt(start + WINDOW_MS - 1, start, end)).toEqual({ fromMs: start, lengthMs: WINDOW_MS });
    expect(windowAt(end, start, end)).toEqual({ fromMs: start + 2 * WINDOW_MS, lengthMs: WINDOW_MS / 2 });
    expect(windowAt(0, start, start)).toEqual({ fromMs: start, lengthMs: 1 });
  });

  it("comes into step by its speed, whatever it is late at first, and jumps with the replay", () => {
    for (const speed of [0.5, 1, 2]) {
      for (const lateMs of [-900, -150, 0, 150, 900]) {
        let [media, replay] = [50_000, 50_000 + lateMs];
        for (let second = 0; second < 30; second += 0.5) {
          const { jumpMs, rate } = correction(media, replay, speed);
          expect(jumpMs).toBeNull();
          media += 500 * rate;
          replay += 500 * speed;
        }
        expect(Math.abs(replay - media)).toBeLessThan(50);
      }
    }
    expect(correction(10_000, 70_000, 1)).toEqual({ jumpMs: 70_000, rate: 1 });
    expect([0.25, 0.5, 1, 2, 4].map(isUnderstood)).toEqual([false, true, true, true, false]);
  });
});
