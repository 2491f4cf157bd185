import { describe, expect, it } from "vitest";
import { REPEAT_AFTER_MS, NO_TONES_YET, nextTone, type ToneInput, type ToneState } from "../src/live/alarmTones";
import { titleOf } from "../src/title";
import { alarm } from "./fixtures";

function heard(change: Partial<ToneInput>): ToneInput {
  return { alarms: [], linkLost: false, nowMs: 0, ...change };
}

function after(...moments: Partial<ToneInput>[]): (string | null)[] {
  let toneState: ToneState = NO_TONES_YET;
  return moments.map((moment) => {
    const next = nextTone(heard(moment), toneState);
    toneState = next.toneState;
    return next.tone;
  });
}

const FALL = alarm("fall");
const HEAT = alarm("heat", { priority: 2 });

describe("what is to be heard", () => {
  it("is nothing while all is well", () => {
    expect(after({}, { nowMs: REPEAT_AFTER_MS })).toEqual([null, null]);
  });

  it("is an immediate alarm at once, and again until somebody takes it", () => {
    const taken = alarm("fall", { state: "acknowledged" });
    expect(
      after(
        { alarms: [FALL] },
        { alarms: [FALL], nowMs: REPEAT_AFTER_MS - 1 },
        { alarms: [FALL], nowMs: REPEAT_AFTER_MS },
        { alarms: [taken], nowMs: 3 * REPEAT_AFTER_MS },
      ),
    ).toEqual(["immediate", null, "immediate", null]);
  });

  it("is nothing for what is only said", () => {
    expect(after({ alarms: [alarm("off", { priority: 3 })] })).toEqual([null]);
  });

  it("is a second immediate alarm without waiting", () => {
    const both = [FALL, alarm("mayday")];
    expect(after({ alarms: [FALL] }, { alarms: both, nowMs: 100 })).toEqual([
      "immediate",
      "immediate",
    ]);
  });

  it("is what has become immediate without waiting, and nothing for what has eased", () => {
    const critical = alarm("heat", { priority: 1, last_raised_ms: 100 });
    const eased = alarm("heat", { priority: 2, last_raised_ms: 100 });
    expect(
      after(
        { alarms: [HEAT] },
        { alarms: [critical], nowMs: 100 },
        { alarms: [eased], nowMs: 200 },
      ),
    ).toEqual(["soon", "immediate", null]);
  });

  it("is what was raised anew before anybody took it, such as another fault", () => {
    const other = alarm("heat", { priority: 2, last_raised_ms: 100 });
    expect(after({ alarms: [HEAT] }, { alarms: [other], nowMs: 100 })).toEqual(["soon", "soon"]);
  });

  it("is an alarm of the second priority once, and information never", () => {
    const news = alarm("news", { priority: 3 });
    expect(
      after({ alarms: [HEAT, news] }, { alarms: [HEAT, news], nowMs: 5 * REPEAT_AFTER_MS }),
    ).toEqual(["soon", null]);
  });

  it("is the loss of the station, as often as an alarm", () => {
    expect(
      after({ linkLost: true }, { linkLost: true, nowMs: 1 }, { linkLost: true, nowMs: REPEAT_AFTER_MS }),
    ).toEqual(["link", null, "link"]);
  });
});

it("the title says what is wrong", () => {
  expect(titleOf(false, false, 0)).toBe("Muster");
  expect(titleOf(false, false, 2)).toBe("(2!) Muster");
  expect(titleOf(false, true, 2)).toBe("Replay – Muster");
  expect(titleOf(true, false, 2)).toContain("NO CONNECTION");
});
