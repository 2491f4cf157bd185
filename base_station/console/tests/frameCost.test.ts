import { expect, it } from "vitest";
import { isSlow, noteFrame } from "../src/live/frameCost";

it("is slow only once frames take long again and again, and no longer once they are short", () => {
  const isSlowAfter = (ms: number, frames: number) => {
    for (let i = 0; i < frames; i++) noteFrame(ms);
    return isSlow();
  };
  expect(isSlowAfter(20, 100)).toBe(false);
  expect(isSlowAfter(150, 1)).toBe(false);
  expect(isSlowAfter(150, 5)).toBe(true);
  expect(isSlowAfter(20, 20)).toBe(false);
});
