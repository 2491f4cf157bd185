import { beforeEach, describe, expect, it } from "vitest";
import { Picture } from "../src/live/picture";
import { apply } from "../src/live/state";
import { beginOnAFloor } from "../src/plan/floorShown";
import { floor } from "../src/uiState";
import { position, snapshot, unit } from "./fixtures";

function peopleOn(picture: Picture, ...floors: number[]): void {
  const units = floors.map((one, i) => unit(`${i}`, { position: position({ floor: one }) }));
  const { state } = apply(null, snapshot({ units }));
  if (state !== null) picture.show(state);
}

beforeEach(() => {
  floor.value = "all";
});

describe("the floor that is shown", () => {
  it("is where most people are as soon as there are any, and then stays", () => {
    const picture = new Picture();
    const end = beginOnAFloor(picture);
    peopleOn(picture);
    expect(floor.value).toBe("all");
    peopleOn(picture, 1, 1, 0);
    expect(floor.value).toBe(1);
    peopleOn(picture, 0, 0, 0);
    expect(floor.value).toBe(1);
    end();
  });

  it("is the one that somebody chose before anybody was there", () => {
    const picture = new Picture();
    const end = beginOnAFloor(picture);
    floor.value = 2;
    peopleOn(picture, 0);
    expect(floor.value).toBe(2);
    end();
  });

  it("is after a replay the one that was left", () => {
    const [live, past] = [new Picture(), new Picture()];
    peopleOn(live, 0, 0, 1);
    peopleOn(past, 3);
    const leaveLive = beginOnAFloor(live);
    floor.value = 1;
    leaveLive();
    const leavePast = beginOnAFloor(past);
    expect(floor.value).toBe(3);
    leavePast();
    const end = beginOnAFloor(live);
    expect(floor.value).toBe(1);
    peopleOn(live, 0, 0, 0);
    expect(floor.value).toBe(1);
    end();
  });
});
