import { describe, expect, it } from "vitest";
import { Picture } from "../src/live/picture";
import { apply, type State } from "../src/live/state";
import type { Message, UnitChange } from "../src/wire";
import { position, snapshot, unit } from "./fixtures";

/** A picture that follows messages, without a clock. */
class Followed {
  readonly picture = new Picture();
  private state: State | null = null;

  hear(message: Message): void {
    this.state = apply(this.state, message).state;
    if (this.state !== null) this.picture.show(this.state);
  }

  change(seq: number, change: UnitChange): void {
    this.hear({ type: "field_delta", seq, after_seq: seq - 1, now_ms: 2_000, units: { a: change } });
  }
}

function walking(): Followed {
  const followed = new Followed();
  followed.hear(snapshot({ units: [unit("a", { position: position({ north_m: 1 }) })] }));
  return followed;
}

describe("a unit on its card", () => {
  it("shows where it is with the clock, and the plan has it at once", () => {
    const followed = walking();
    const { picture } = followed;
    followed.change(11, { position: { north_m: 5 } });
    expect(picture.allUnits()[0]?.position?.north_m).toBe(5);
    expect(picture.unit("a")?.value.position?.north_m).toBe(1);
    picture.catchUp();
    expect(picture.unit("a")?.value.position?.north_m).toBe(5);
  });

  it.each<UnitChange>([
    { link: "lost" },
    { alarms: ["x"] },
    { position: null },
    { status: { mayday: true } },
  ])("shows at once what matters: %o", (change) => {
    const followed = walking();
    followed.change(11, { position: { north_m: 5 } });
    followed.change(12, change);
    const shown = followed.picture.unit("a")?.value;
    expect(shown).toBe(followed.picture.allUnits()[0]);
    followed.picture.catchUp();
    expect(followed.picture.unit("a")?.value).toBe(shown);
  });

  it("goes on with the clock seldom while it is not on the screen, and at once where it comes there", () => {
    const followed = walking();
    const { picture } = followed;
    picture.see("a", false);
    followed.change(11, { position: { north_m: 5 } });
    const shown = () => picture.unit("a")?.value.position?.north_m;
    let steps = 0;
    while (shown() === 1 && steps < 100) {
      picture.catchUp();
      steps += 1;
    }
    expect(steps).toBeLessThanOrEqual(10);
    followed.change(12, { position: { north_m: 9 } });
    picture.nowMs.value = 7_000;
    picture.catchUp();
    expect([shown(), picture.nowMsOf("a")]).toEqual([5, 0]);
    picture.see("a", true);
    expect([shown(), picture.nowMsOf("a")]).toEqual([9, 7_000]);
  });

  it("is of one time with what it shows, also where that cannot wait", () => {
    const followed = walking();
    followed.picture.see("a", false);
    followed.picture.nowMs.value = 7_000;
    followed.change(11, { alarms: ["x"] });
    expect(followed.picture.nowMsOf("a")).toBe(7_000);
  });

  it("shows all of a whole picture at once", () => {
    const followed = walking();
    followed.picture.see("a", false);
    followed.change(11, { position: { north_m: 5 } });
    followed.picture.catchUp(true);
    expect(followed.picture.unit("a")?.value.position?.north_m).toBe(5);
  });

  it("is gone with the picture that no longer has it", () => {
    const followed = walking();
    followed.change(11, { position: { north_m: 5 } });
    followed.hear(snapshot({ seq: 12 }));
    followed.picture.catchUp();
    expect(followed.picture.unit("a")).toBeUndefined();
  });
});
