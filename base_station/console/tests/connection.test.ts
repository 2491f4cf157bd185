import { beforeEach, describe, expect, it } from "vitest";
import {
  Connection,
  NOT_LOGGED_IN,
  PICTURE_MS,
  retryDelayMs,
  SILENCE_MS,
  type Surroundings,
} from "../src/live/connection";

class FakeSocket {
  readyState = 1;
  sent: string[] = [];
  onopen: (() => void) | null = null;
  onclose: ((event: { code: number }) => void) | null = null;
  onmessage: ((event: { data: string }) => void) | null = null;
  send(text: string) {
    this.sent.push(text);
  }
  close() {
    this.readyState = 3;
  }
}

interface Timer {
  action: () => void;
  delayMs: number;
}

let sockets: FakeSocket[];
let timers: Set<Timer>;
let heard: string[];
let frames: ((drawnMs: number) => void)[];
let nowMs: number;
let showMs: number;
let connection: Connection;

function fire(delayMs: number): void {
  for (const timer of [...timers]) {
    if (timer.delayMs !== delayMs) continue;
    timers.delete(timer);
    timer.action();
  }
}

/** What was shown comes on the screen, after the page did something else for a while. */
function draw(drawnMs: number, elseMs = 0): void {
  nowMs += elseMs + drawnMs;
  for (const frame of frames.splice(0)) frame(drawnMs);
}

beforeEach(() => {
  sockets = [];
  timers = new Set();
  heard = [];
  frames = [];
  nowMs = 0;
  showMs = 0;
  const around: Surroundings = {
    open: () => {
      const socket = new FakeSocket();
      sockets.push(socket);
      return socket as unknown as WebSocket;
    },
    later: (action, delayMs) => {
      const timer = { action, delayMs };
      timers.add(timer);
      return timer;
    },
    cancel: (timer) => void timers.delete(timer as Timer),
    random: () => 1,
    nowMs: () => nowMs,
    afterFrame: (action) => void frames.push(action),
  };
  connection = new Connection(
    "ws://station",
    {
      message: (text) => {
        heard.push(text);
        nowMs += showMs;
      },
      up: () => heard.push("up"),
      down: (delayMs) => heard.push(`down ${delayMs}`),
      refused: (code) => heard.push(`refused ${code}`),
    },
    around,
  );
});

describe("Connection", () => {
  it("passes on what arrives", () => {
    sockets[0]?.onopen?.();
    sockets[0]?.onmessage?.({ data: "{}" });
    expect(heard).toEqual(["up", "{}"]);
  });

  it("says that it is down and comes back, waiting longer each time", () => {
    sockets[0]?.onclose?.({ code: 1006 });
    fire(300);
    sockets[1]?.onclose?.({ code: 1006 });
    expect(heard).toEqual(["down 300", "down 600"]);
    expect(sockets).toHaveLength(2);
  });

  it("begins to wait from the start again once something has arrived", () => {
    sockets[0]?.onclose?.({ code: 1006 });
    fire(300);
    sockets[1]?.onmessage?.({ data: "{}" });
    sockets[1]?.onclose?.({ code: 1006 });
    expect(heard.at(-1)).toBe("down 300");
  });

  it("asks when the station is silent, and stays up when it answers", () => {
    fire(SILENCE_MS);
    expect(sockets[0]?.sent).toEqual(['{"type":"snapshot"}']);
    sockets[0]?.onmessage?.({ data: "{}" });
    fire(SILENCE_MS);
    expect(heard).toEqual(["{}"]);
  });

  it("does not try again where the station refuses", () => {
    sockets[0]?.onclose?.({ code: NOT_LOGGED_IN });
    expect(heard).toEqual([`refused ${NOT_LOGGED_IN}`]);
    expect(timers.size).toBe(0);
  });

  it("takes silence for a lost link, though the socket has not noticed", () => {
    sockets[0]?.onopen?.();
    sockets[0]?.onmessage?.({ data: "{}" });
    draw(0);
    fire(0);
    fire(SILENCE_MS);
    fire(SILENCE_MS);
    expect(heard).toEqual(["up", "{}", "down 300"]);
    expect(sockets[0]?.readyState).toBe(3);
  });

  it("waits longer for the first picture, and then no more", () => {
    sockets[0]?.onopen?.();
    fire(SILENCE_MS);
    expect([sockets[0]?.sent, heard]).toEqual([[], ["up"]]);
    fire(PICTURE_MS);
    expect(heard).toEqual(["up", "down 300"]);
  });

  it("does not wait so long where nobody answers at all", () => {
    fire(SILENCE_MS);
    fire(SILENCE_MS);
    expect(heard).toEqual(["down 300"]);
  });

  it("does not come back after it was closed", () => {
    connection.close();
    expect(timers.size).toBe(0);
    expect(heard).toEqual([]);
  });
});

describe("retryDelayMs", () => {
  it("is spread over half of its length and has a limit", () => {
    expect(retryDelayMs(0, 0)).toBe(150);
    expect(retryDelayMs(0, 1)).toBe(300);
    expect(retryDelayMs(20, 1)).toBe(5000);
  });
});

describe("what was shown", () => {
  const receive = (text: string) => sockets[0]?.onmessage?.({ data: text });

  it("is confirmed once it is on the screen, and the page has rested as long as it was busy", () => {
    receive("one");
    expect(timers).not.toContainEqual(expect.objectContaining({ delayMs: 120 }));
    draw(120);
    expect(sockets[0]?.sent).toEqual([]);
    fire(120);
    expect(sockets[0]?.sent).toEqual(['{"type":"shown","count":1}']);
  });

  it("is confirmed together, and what came since then after its own frame", () => {
    receive("one");
    receive("two");
    draw(30);
    receive("three");
    fire(30);
    draw(20);
    fire(20);
    expect(sockets[0]?.sent).toEqual(['{"type":"shown","count":2}', '{"type":"shown","count":3}']);
  });

  it("is no later for what else the page did meanwhile, and is for its own work", () => {
    showMs = 30;
    receive("one");
    draw(20, 5_000);
    fire(50);
    expect(sockets[0]?.sent).toEqual(['{"type":"shown","count":1}']);
  });

  it("rests for a fifth of a second at most", () => {
    receive("one");
    draw(9_000);
    fire(200);
    expect(sockets[0]?.sent).toEqual(['{"type":"shown","count":1}']);
  });

  it("is not confirmed over a connection that has ended", () => {
    receive("one");
    draw(40);
    sockets[0]?.onclose?.({ code: 1006 });
    fire(40);
    expect(sockets[0]?.sent).toEqual([]);
  });
});
