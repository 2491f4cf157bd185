import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { MAX_ACT_MS, act, call, unanswered } from "../src/http";

const OK = () => new Response(null, { status: 204 });
const refused = () => new Response(JSON.stringify({ detail: "No." }), { status: 409 });
const sent = vi.fn<(path: string, init: RequestInit) => Promise<Response>>();

/** As a connection does that has died unnoticed. */
function silent(_: string, { signal }: RequestInit): Promise<Response> {
  return new Promise((_, fail) => signal?.addEventListener("abort", () => fail(signal.reason)));
}

function keys(): (string | null)[] {
  return sent.mock.calls.map(([, init]) => new Headers(init.headers).get("idempotency-key"));
}

beforeEach(() => {
  vi.useFakeTimers();
  vi.spyOn(AbortSignal, "timeout").mockImplementation((ms) => {
    const ends = new AbortController();
    setTimeout(() => ends.abort(new DOMException("", "TimeoutError")), ms);
    return ends.signal;
  });
  vi.stubGlobal("fetch", sent);
});

afterEach(() => {
  sent.mockReset();
  vi.restoreAllMocks();
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

describe("what the station is to do", () => {
  it("is asked for once more with the same key where no answer comes", async () => {
    sent.mockImplementationOnce(silent).mockImplementationOnce(() => Promise.resolve(OK()));
    const done = act("POST", "/check-ins", { target: { everyone: true } });
    await vi.advanceTimersByTimeAsync(MAX_ACT_MS);
    await expect(done).resolves.toBeUndefined();
    const [first, again] = keys();
    expect(first).toMatch(/^[0-9a-f]{32}$/);
    expect([again, sent.mock.calls.length]).toEqual([first, 2]);
    expect(sent.mock.calls[1]?.[1].body).toBe(sent.mock.calls[0]?.[1].body);
  });

  it("is asked for once more where the station cannot be reached, and then given up", async () => {
    sent.mockImplementation(() => Promise.reject(new TypeError("failed")));
    await expect(act("POST", "/commands", {})).rejects.toThrow("No reply from the base station");
    expect(sent.mock.calls.length).toBe(2);
  });

  it("is given up in the end", async () => {
    sent.mockImplementation(silent);
    const done = expect(act("POST", "/commands", {})).rejects.toThrow("No reply from the base station");
    await vi.advanceTimersByTimeAsync(MAX_ACT_MS);
    await done;
    expect(sent.mock.calls.length).toBe(2);
  });

  it("is not asked for again where it is refused", async () => {
    sent.mockImplementation(() => Promise.resolve(refused()));
    await expect(act("POST", "/commands", {})).rejects.toThrow("No.");
    expect(sent.mock.calls.length).toBe(1);
  });

  it("has a key of its own each time", async () => {
    sent.mockImplementation(() => Promise.resolve(OK()));
    await act("POST", "/check-ins", {});
    await act("POST", "/check-ins", {});
    expect(new Set(keys()).size).toBe(2);
  });
});

it("counts what is told to the station for as long as no answer comes", async () => {
  sent.mockImplementation(silent);
  const told = act("POST", "/commands", {}).catch(() => undefined);
  const asked = call("GET", "/people").catch(() => undefined);
  await vi.advanceTimersByTimeAsync(500);
  expect(unanswered.value).toBe(0); // nobody wonders yet
  await vi.advanceTimersByTimeAsync(500);
  expect(unanswered.value).toBe(1); // and not who only looks
  await vi.advanceTimersByTimeAsync(MAX_ACT_MS);
  await told;
  expect(unanswered.value).toBe(0);
  void asked;
});

it("asks for anything else once, and without a key", async () => {
  sent.mockImplementation(() => Promise.reject(new TypeError("failed")));
  await expect(call("POST", "/replays", {})).rejects.toThrow("No reply from the base station");
  expect(keys()).toEqual([null]);
});
