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

  it("is gone with the picture that no longer has it", () => {
    const followed = walking();
    followed.change(11, { position: { north_m: 5 } });
    followed.hear(snapshot({ seq: 12 }));
    followed.picture.catchUp();
    expect(followed.picture.unit("a")).toBeUndefined();
  });
});
