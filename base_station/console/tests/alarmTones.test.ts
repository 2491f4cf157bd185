import { describe, expect, it } from "vitest";
import { NO_TONES_YET, REPEAT_AFTER_MS as REPEATS, nextTone, type ToneInput, type ToneState } from "../src/live/alarmTones";
import { burst } from "../src/live/tonePulses";
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

const REPEAT_AFTER_MS = REPEATS.high;
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
    ).toEqual(["high", null, "high", null]);
  });

  it("is a second immediate alarm without waiting", () => {
    const both = [FALL, alarm("mayday")];
    expect(after({ alarms: [FALL] }, { alarms: both, nowMs: 100 })).toEqual([
      "high",
      "high",
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
    ).toEqual(["medium", "high", null]);
  });

  it("is what was raised anew before anybody took it, such as another fault", () => {
    const other = alarm("heat", { priority: 2, last_raised_ms: 100 });
    expect(after({ alarms: [HEAT] }, { alarms: [other], nowMs: 100 })).toEqual(["medium", "medium"]);
  });

  it("is a warning and an advisory again too, and seldom", () => {
    const news = alarm("news", { priority: 3 });
    const alone = (one: typeof news, ...times: number[]) =>
      after(...times.map((nowMs) => ({ alarms: [one], nowMs })));
    expect(alone(HEAT, 0, REPEATS.medium - 1, REPEATS.medium)).toEqual(["medium", null, "medium"]);
    expect(alone(news, 0, REPEATS.low - 1, REPEATS.low)).toEqual(["low", null, "low"]);
    expect(alone(alarm("taken", { priority: 2, state: "acknowledged" }), 0, REPEATS.medium)).toEqual([null, null]);
  });

  it("is only the most urgent of what is repeated, and the lost station besides", () => {
    const alarms = [FALL, HEAT];
    expect(
      after({ alarms }, { alarms, nowMs: 25_000 }, { alarms, linkLost: true, nowMs: 26_000 }, { alarms, linkLost: true, nowMs: 30_000 }),
    ).toEqual(["high", "high", null, "link"]);
  });

  it("is the loss of the station, as often as an alarm", () => {
    expect(
      after({ linkLost: true }, { linkLost: true, nowMs: 1 }, { linkLost: true, nowMs: REPEAT_AFTER_MS }),
    ).toEqual(["link", null, "link"]);
  });
});

/** IEC 60601-1-8:2006+A1:2012, tables 3 and 4; times in ms. */
describe("a burst", () => {
  const gaps = (tone: Parameters<typeof burst>[0]) => {
    const pulses = burst(tone);
    return pulses.slice(1).map((pulse, i) => {
      const before = pulses[i];
      return before === undefined ? NaN : 1000 * (pulse.startS - before.startS - before.durationS);
    });
  };
  const within = (value: number, [least, most]: readonly [number, number]) =>
    value >= least - 1e-6 && value <= most + 1e-6;

  it("of high priority is ten pulses, three and two, twice", () => {
    const pulses = burst("high");
    expect(pulses).toHaveLength(10);
    expect(pulses.every(({ durationS }) => within(1000 * durationS, [75, 200]))).toBe(true);
    const all = gaps("high");
    const x = all[0] ?? NaN;
    expect(within(x, [50, 125])).toBe(true);
    expect(within(all[4] ?? NaN, [350, 1300])).toBe(true);
    const missing = 2 * x + 1000 * (pulses[0]?.durationS ?? NaN);
    const half = [x, x, missing, x];
    [...half, all[4] ?? NaN, ...half].forEach((gap, i) => expect(all[i]).toBeCloseTo(gap, 6));
  });

  it.each([
    ["medium", 3],
    ["low", 2],
  ] as const)("of %s priority is %i slower pulses", (tone, count) => {
    const pulses = burst(tone);
    expect(pulses).toHaveLength(count);
    expect(pulses.every(({ durationS }) => within(1000 * durationS, [125, 250]))).toBe(true);
    expect(gaps(tone).every((gap) => within(gap, [125, 250]))).toBe(true);
  });

  it("is over before a repeat may follow, and is low enough for every ear", () => {
    for (const tone of ["high", "medium", "low", "link"] as const) {
      const last = burst(tone).at(-1);
      expect(1 + (last?.startS ?? NaN) + (last?.durationS ?? NaN)).toBeLessThan(5);
      expect(burst(tone).every(({ pitchHz }) => within(pitchHz, [150, 1000]))).toBe(true);
    }
  });
});

it("the title says what is wrong", () => {
  expect(titleOf(false, false, 0)).toBe("Muster");
  expect(titleOf(false, false, 2)).toBe("(2!) Muster");
  expect(titleOf(false, true, 2)).toBe("Replay – Muster");
  expect(titleOf(true, false, 2)).toContain("NO CONNECTION");
});
