import { describe, expect, it } from "vitest";
import { isOld, outline, regionAt, ring } from "../src/plan/ellipse";
import { firstFloor, floorBadge, floorRemark, floorsOf } from "../src/plan/floors";
import type { Colours } from "../src/plan/colours";
import {
  colourOf,
  isHollow,
  isStrong,
  labelOf,
  lettersOf,
  type Mark,
} from "../src/plan/marks";
import { placeNames, type Box, type Named, type Pixel, type Place } from "../src/plan/names";
import { isNamed, pinWords } from "../src/plan/pins";
import { joinedByTime, spanMs, TRAIL_MS, trailLines } from "../src/plan/trail";
import type { PinView, Plan, TrailPoint } from "../src/wire";
import { alarm, position, unit } from "./fixtures";

const PLAN: Plan = {
  type: "FeatureCollection",
  muster: {
    frame: "site-m",
    floors: [
      { floor: 0, down_m: 0 },
      { floor: 1, down_m: -3.2 },
    ],
  },
  features: [],
};

describe("the region of a position", () => {
  it("is as the station stated while the station can be heard", () => {
    expect(regionAt(position(), 0).major_m).toBe(2);
  });

  it("grows in every direction while the station cannot be heard", () => {
    const region = regionAt(position(), 30_000);
    expect(region.major_m).toBe(32);
    expect(region.minor_m).toBe(31);
  });

  it("keeps to what the walls leave while the station can be heard", () => {
    const reach: [number, number][] = [
      [0, 0],
      [4, 0],
      [4, 3],
    ];
    const silent = position({ reach });
    expect(outline([0, 0], silent, 0)).toEqual([...reach, [0, 0]]);
    expect(outline([0, 0], silent, 5_000)).toEqual(ring([0, 0], regionAt(silent, 5_000)));
    expect(outline([0, 0], position(), 0)).toEqual(ring([0, 0], regionAt(position(), 0)));
  });

  it("belongs to an old position after ten seconds", () => {
    expect(isOld(position(), 10_999)).toBe(false);
    expect(isOld(position(), 11_000)).toBe(true);
  });

  it("is long in the direction of its heading, clockwise from north", () => {
    const region = { major_m: 5, minor_m: 1, heading_rad: Math.PI / 2 };
    const points = ring([10, 20], region);
    const east = Math.max(...points.map(([x]) => x));
    const north = Math.max(...points.map(([, y]) => y));
    expect(east).toBeCloseTo(15);
    expect(north).toBeCloseTo(21);
    expect(points[0]).toEqual(points.at(-1));
  });
});

describe("floorsOf", () => {
  const people = [
    unit("a", { position: position({ floor: 1 }), alarms: ["x"] }),
    unit("b", { position: position({ floor: 1 }) }),
    unit("c", { position: position({ floor: -1 }) }),
    unit("d", { position: position({ floor: null }) }),
    unit("e"),
  ];

  it("lists the plan's floors and those where somebody is, top floor first", () => {
    const floors = floorsOf(PLAN, people, new Map([["x", alarm("x")]]));
    expect(floors.map((one) => [one.name, one.people, one.endangered])).toEqual([
      ["1", 2, 1],
      ["G", 0, 0],
      ["B1", 1, 0],
    ]);
  });

  it("keeps the one that is looked at, where nobody is any more and no plan has it", () => {
    const names = (shown: number | "all") =>
      floorsOf(null, people, new Map(), shown).map((one) => `${one.name}: ${one.people}`);
    expect(names(3)).toEqual(["3: 0", "1: 2", "B1: 1"]);
    expect(names(1)).toEqual(["1: 2", "B1: 1"]);
    expect(names("all")).toEqual(["1: 2", "B1: 1"]);
  });

  it("begins where most people are", () => {
    expect(firstFloor(floorsOf(PLAN, people, new Map()))).toBe(1);
    expect(firstFloor([])).toBeNull();
  });
});

describe("floorRemark", () => {
  it("is empty where the floor that is shown says it all", () => {
    expect(floorRemark(position({ floor: 1 }), 1)).toBe("");
    expect(floorRemark(position({ floor: 1, floor_probability: 0.5 }), 1)).toBe("");
  });

  it("says who is on another floor, or on one that nobody knows", () => {
    expect(floorRemark(position({ floor: 1 }), 0)).toBe("floor 1");
    expect(floorRemark(position({ floor: null }), 0)).toBe("floor unknown");
    expect(floorRemark(position({ floor: 0, floor_probability: 0.49 }), 0)).toBe("floor unknown");
    expect(floorRemark(position({ floor: 1, floor_probability: 0.49 }), 0)).toBe("floor unknown");
  });

  it("says each one's floor where all floors are shown", () => {
    expect(floorRemark(position({ floor: 1 }), "all")).toBe("floor 1");
    expect(floorRemark(position({ floor: null }), "all")).toBe("floor unknown");
    expect(floorRemark(position({ floor: 2, floor_probability: 0.3 }), "all")).toBe("floor unknown");
  });

  it("says that a floor is the last one that is known of somebody who is not heard", () => {
    expect(floorRemark(position({ floor: 1 }), 0, true)).toBe("last on floor 1");
    expect(floorRemark(position({ floor: 1 }), 1, true)).toBe("");
  });
});

describe("somebody on another floor", () => {
  it("has an arrow with the number of floors, or the floor where all are shown", () => {
    const arrow = (floor: number | null, shown: number | "all", sure: number | null = null) =>
      floorBadge(position({ floor, floor_probability: sure }), shown);
    expect(arrow(4, 2)).toBe("▲2");
    expect(arrow(-1, 0)).toBe("▼1");
    expect([arrow(2, 2), arrow(null, 2), arrow(4, 2, 0.4)]).toEqual(["", "", ""]);
    expect([arrow(4, "all"), arrow(0, "all"), arrow(null, "all"), arrow(4, "all", 0.4)]).toEqual(["4", "G", "?", "?"]);
  });

  it("is drawn hollow, as who is old", () => {
    expect(isHollow({ old: false, floorsUp: -1 })).toBe(true);
    expect(isHollow({ old: true, floorsUp: 0 })).toBe(true);
    expect(isHollow({ old: false, floorsUp: 0 })).toBe(false);
  });
});

describe("where names stand on the plan", () => {
  const screen: Pixel = [500, 400];
  const named = (mark: Pixel, change: Partial<Named> = {}): Named => {
    return { mark, widthPx: 120, strong: false, first: false, before: null, ...change };
  };
  const placed = (people: Named[], covered: Box[] = [], standing: Box[] = []) =>
    placeNames(people, { size: screen, covered, standing });
  /** What the name of somebody covers, with 8 pixels of a line above and below its middle. */
  const boxOf = ({ mark: [x, y], widthPx }: Named, place: Place | null | undefined): Box => {
    const [right, down] = place?.offset ?? [NaN, NaN];
    const [middle, line] = [x + right, y + down];
    return [middle - widthPx / 2, line - 8, middle + widthPx / 2, line + 8];
  };
  const meet = ([a1, b1, a2, b2]: Box, [c1, d1, c2, d2]: Box) =>
    a1 < c2 && c1 < a2 && b1 < d2 && d1 < b2;
  const markOf = ({ mark: [x, y] }: Named): Box => [x - 13, y - 13, x + 13, y + 13];

  it("is under the mark where there is room", () => {
    expect(placed([named([250, 200])])).toEqual([{ side: "below", offset: [0, 25] }]);
  });

  it.each<Pixel>([
    [3, 200],
    [497, 200],
    [250, 398],
    [3, 398],
    [497, 0],
    [250, 0],
  ])("is on the screen where the mark is at %i, %i", (x, y) => {
    const one = named([x, y]);
    const [left, top, right, bottom] = boxOf(one, placed([one])[0]);
    expect([left >= 0, top >= 0, right <= 500, bottom <= 400]).toEqual([true, true, true, true]);
  });

  it("begins on the screen where it is longer than that, and only of who must be named", () => {
    const long = named([250, 200], { widthPx: 700, strong: true });
    expect(boxOf(long, placed([long])[0])[0]).toBeGreaterThanOrEqual(0);
    expect(placed([{ ...long, strong: false }])).toEqual([null]);
  });

  it("is not said of who is beside the screen", () => {
    for (const mark of [[-1, 200], [501, 200], [250, -1], [250, 401]] as const) {
      expect(placed([named(mark, { strong: true })])).toEqual([null]);
    }
  });

  it("lies over nobody's mark, no other name and no button", () => {
    const people = [named([250, 200]), named([270, 220]), named([230, 226]), named([252, 171])];
    const button: Box = [150, 150, 235, 215];
    const places = placed(people, [button]);
    const boxes = people.flatMap((one, i) => (places[i] ? [boxOf(one, places[i])] : []));
    expect(boxes.length).toBeGreaterThan(0);
    for (const box of boxes) {
      const others = [...people.map(markOf), ...boxes.filter((one) => one !== box), button];
      expect(others.filter((one) => meet(box, one))).toEqual([]);
    }
  });

  it("of who is in danger lies rather over a pin than under a button", () => {
    const danger = named([250, 200], { strong: true, widthPx: 400 });
    const button: Box = [400, 190, 450, 300]; // below it
    const pin: Box = [240, 160, 260, 190]; // above it
    const [place] = placed([danger], [button], [pin]);
    expect(place?.side).toBe("above");
    expect(placed([{ ...danger, strong: false }], [button], [pin])).toEqual([null]);
  });

  it("of two in danger at one place is read beside the other", () => {
    const two = [named([250, 200], { strong: true }), named([256, 203], { strong: true })];
    const [one, other] = placed(two).map((place, i) => boxOf(two[i] as Named, place));
    expect(meet(one as Box, other as Box)).toBe(false);
  });

  it("of who is in danger stands, whoever else has to go without", () => {
    const calm = Array.from({ length: 20 }, (_, i) => named([200 + 5 * i, 190 + (i % 3) * 10]));
    const danger = named([250, 200], { strong: true });
    const places = placed([...calm, danger]);
    const box = boxOf(danger, places[20]);
    expect(box.every(Number.isFinite)).toBe(true);
    calm.forEach((one, i) => {
      if (places[i]) expect(meet(boxOf(one, places[i]), box)).toBe(false);
      if (places[i]) expect(meet(boxOf(one, places[i]), markOf(danger))).toBe(false);
    });
  });

  it("of many in danger lies over no other name, but of who is down", () => {
    const many = Array.from({ length: 30 }, (_, i) => named([240 + i, 200 + (i % 3)], { strong: true }));
    const down = named([250, 201], { strong: true, first: true });
    const places = placed([...many, down]);
    const all = [...many, down];
    const boxes = all.flatMap((one, i) => (places[i] ? [boxOf(one, places[i])] : []));
    expect(places[30]).not.toBeNull();
    expect(boxes.length).toBeLessThan(all.length);
    boxes.forEach((box, i) => {
      expect(boxes.slice(i + 1).filter((other) => meet(box, other))).toEqual([]);
    });
  });

  it("stays on its side while it can", () => {
    expect(placed([named([250, 200], { before: "above" })])[0]?.side).toBe("above");
    expect(placed([named([250, 3], { before: "above" })])[0]?.side).toBe("below");
  });
});

describe("the name of somebody on the plan", () => {
  const mark = {
    name: "Ana",
    initials: "A",
    urgency: "normal",
    chosen: false,
    down: false,
    old: false,
    ageMs: 72_000,
    floor: "",
    floorsUp: 0,
    floorBadge: "",
    headingRad: 0,
    headingKnown: false,
  } as const;
  const nameOf = (change: Partial<Mark>) => labelOf({ ...mark, ...change });

  it("shows danger also where the place is old", () => {
    const looks = { quiet: "grey", immediate: "red", soon: "amber" } as Colours;
    const seen = (change: Partial<Mark>) => {
      const one = { ...mark, initials: "AB", ...change };
      return `${colourOf(one, looks)} ${lettersOf(one)}`;
    };
    expect(seen({ urgency: "immediate" })).toBe("red !AB");
    expect(seen({ urgency: "immediate", old: true })).toBe("red !?AB");
    expect(seen({ urgency: "soon", old: true })).toBe("grey ?");
    expect(seen({ urgency: "soon" })).toBe("amber AB");
  });

  it("is always said of who is in danger or chosen", () => {
    expect(isStrong({ ...mark })).toBe(false);
    expect(isStrong({ ...mark, urgency: "immediate" })).toBe(true);
    expect(isStrong({ ...mark, chosen: true })).toBe(true);
  });

  it("says which floor and how old", () => {
    expect(nameOf({})).toBe("Ana");
    expect(nameOf({ floor: "floor 1", old: true })).toBe("Ana, floor 1, 1\u00a0min old");
  });

  it("leaves others room: of a long name it says the beginning, and all that follows it", () => {
    const long = { name: "W".repeat(80), floor: "floor 1", old: true };
    expect(nameOf(long)).toBe(`${"W".repeat(23)}…, floor 1, 1\u00a0min old`);
    expect(nameOf({ name: "Wolfeschlegel von Bergen" })).toBe("Wolfeschlegel von Bergen");
  });
});

describe("the name at a pin", () => {
  it.each([
    ["used", 1, false],
    ["conflict", 1, true],
    ["waiting", 1, true], // who is not heard was there later than the plan shows
    ["waiting", 0, false], // all who start there
  ])("stands there of one that is %s, of the time %i: %s", (state, t_ms, named) => {
    expect(isNamed({ state, t_ms } as PinView)).toBe(named);
  });

  it("is no person's: it says that it is a pin", () => {
    expect(pinWords({ t_ms: 0 } as PinView, "W".repeat(80))).toBe(`Pin: ${"W".repeat(23)}…, start`);
  });
});

describe("trailLines", () => {
  const walk: TrailPoint[] = [
    [0, 0, 0, 0],
    [1_000, 1, 0, 0],
    [2_000, 2, 5, 1],
    [3_000, 3, 5, 1],
    [60_000, 4, 5, 1, 1],
    [61_000, 5, 5, 1],
  ];

  it("is whole of who is chosen or in danger, and of others the last minutes", () => {
    expect([spanMs(true), spanMs(false, "immediate")]).toEqual([Infinity, Infinity]);
    expect([spanMs(false), spanMs(false, "soon")]).toEqual([TRAIL_MS, TRAIL_MS]);
    expect(trailLines(walk, 3_600_000, "all", spanMs(false, "immediate"))).toHaveLength(2);
  });

  it("goes on over a line of which the station has left points out", () => {
    const thinned = walk.map((point): TrailPoint => [point[0], point[1], point[2], point[3]]);
    expect(trailLines(thinned, 61_000, "all")).toHaveLength(1);
    expect(trailLines(thinned, 61_000, "all", TRAIL_MS, joinedByTime)).toHaveLength(2);
  });

  it("is [east, north], broken where nobody knows the way", () => {
    expect(trailLines(walk, 61_000, "all")).toEqual([
      [
        [0, 0],
        [0, 1],
        [5, 2],
        [5, 3],
      ],
      [
        [5, 4],
        [5, 5],
      ],
    ]);
  });

  it("shows one floor, and only the last minutes", () => {
    expect(trailLines(walk, 3_000, 0)).toEqual([
      [
        [0, 0],
        [0, 1],
      ],
    ]);
    expect(trailLines(walk, 3_600_000, "all")).toEqual([]);
  });

  it("does not join two ways on a floor of who was on another meanwhile", () => {
    const back: TrailPoint[] = [...walk.slice(0, 4), [4_000, 9, 0, 0], [5_000, 9, 1, 0]];
    expect(trailLines(back, 5_000, 0)).toEqual([
      [
        [0, 0],
        [0, 1],
      ],
      [
        [0, 9],
        [1, 9],
      ],
    ]);
  });
});
