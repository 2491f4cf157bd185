import { describe, expect, it } from "vitest";
import { ApiError } from "../src/http";
import { followUp } from "../src/live/unanswered";

const UNKNOWN = new ApiError("Nothing was carried out with this Idempotency-Key.", 404);
const AWAY = new ApiError("The station cannot be reached.", 0);

/** What is said in the end, and when, of a station that answers so at each of these times. */
async function after(answer: (atMs: number) => number | ApiError, heardFromMs = 0) {
  const said: string[] = [];
  let nowMs = 0;
  await followUp("k1", {
    ask: async () => {
      const done = answer(nowMs);
      if (done instanceof ApiError) throw done;
      return { action: "SendCommand", t_ms: done };
    },
    isHeard: () => nowMs >= heardFromMs,
    say: (sentence) => said.push(sentence),
    wait: async (ms) => void (nowMs += ms),
    nowMs: () => nowMs,
  });
  return { said: said.join(), nowMs };
}

describe("an order that had no answer", () => {
  it("is said to be carried out once the station is heard again", async () => {
    const { said, nowMs } = await after(() => 1_700_000_000_000, 60_000);
    expect(said).toMatch(/was carried out at \d\d:\d\d/);
    expect(nowMs).toBe(60_000);
  });

  it("may wait in the station for a while", async () => {
    const { said } = await after((atMs) => (atMs < 20_000 ? UNKNOWN : 1_700_000_000_000));
    expect(said).toContain("was carried out");
  });

  it("is said not to be carried out, where the station says so for long", async () => {
    const { said, nowMs } = await after(() => UNKNOWN, 10_000);
    expect(said).toContain("was not carried out");
    expect(nowMs).toBeGreaterThanOrEqual(40_000);
  });

  it("is asked for as long as nobody answers", async () => {
    const { said } = await after((atMs) => (atMs < 300_000 ? AWAY : 1_700_000_000_000));
    expect(said).toContain("was carried out");
  });
});
