import { describe, expect, it } from "vitest";
import { isOld, outline, regionAt, ring } from "../src/plan/ellipse";
import { firstFloor, floorRemark, floorsOf } from "../src/plan/floors";
import type { Colours } from "../src/plan/colours";
import { colourOf, labelStyle, lettersOf, type Mark } from "../src/plan/marks";
import { nameAt, UNDER, type Pixel } from "../src/plan/names";
import { pinLabelStyle } from "../src/plan/pins";
import { trailLines } from "../src/plan/trail";
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
    expect(floors.map((one) => [one.name, one.people, one.urgency])).toEqual([
      ["1", 2, "immediate"],
      ["G", 0, "normal"],
      ["B1", 1, "normal"],
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
    expect(floorRemark(position({ floor: 1 }), "all")).toBe("");
  });

  it("says who is on another floor, or on one that nobody knows", () => {
    expect(floorRemark(position({ floor: 1 }), 0)).toBe("floor 1");
    expect(floorRemark(position({ floor: null }), 0)).toBe("floor unknown");
    expect(floorRemark(position({ floor: 0, floor_probability: 0.49 }), 0)).toBe("floor unknown");
    expect(floorRemark(position({ floor: 1, floor_probability: 0.49 }), 0)).toBe("floor unknown");
    expect(floorRemark(position({ floor: null }), "all")).toBe("");
  });
});

describe("where the name of somebody stands on the plan", () => {
  const screen: Pixel = [500, 400];
  /** Left, right and lower edge of a name of 120 pixels. */
  const edges = (mark: Pixel) => {
    const [right, down] = nameAt(mark, 120, screen);
    return [mark[0] + right - 60, mark[0] + right + 60, mark[1] + down + 8];
  };

  it("is under the mark where there is room", () => {
    expect(nameAt([250, 200], 120, screen)).toEqual(UNDER);
  });

  it.each<Pixel>([
    [3, 200],
    [497, 200],
    [250, 398],
    [3, 398],
    [497, 0],
  ])("is on the screen where the mark is at %i, %i", (x, y) => {
    const [left, right, lower] = edges([x, y]) as [number, number, number];
    expect(left).toBeGreaterThanOrEqual(0);
    expect(right).toBeLessThanOrEqual(500);
    expect(lower).toBeLessThanOrEqual(400);
  });

  it("begins on the screen where it is longer than that", () => {
    const [right] = nameAt([250, 200], 700, screen);
    expect(250 + right - 350).toBeGreaterThanOrEqual(0);
  });

  it("stays with a mark that is beside the screen", () => {
    for (const mark of [[-1, 200], [501, 200], [250, -1], [250, 401]] as const) {
      expect(nameAt(mark, 120, screen)).toEqual(UNDER);
    }
  });
});

describe("the name of somebody on the plan", () => {
  const mark = {
    name: "Ana",
    initials: "A",
    urgency: "normal",
    chosen: false,
    old: false,
    ageMs: 72_000,
    floor: "",
    headingRad: 0,
    headingKnown: false,
  } as const;
  const colours = { text: "#000000", halo: "#ffffff" } as Colours;
  const nameOf = (change: Partial<Mark>) => labelStyle({ ...mark, ...change }, colours, UNDER).getText();

  it("shows danger also where the place is old", () => {
    const looks = { quiet: "grey", immediate: "red", soon: "amber" } as Colours;
    const seen = (change: Partial<Mark>) => {
      const one = { ...mark, initials: "AB", ...change };
      return `${colourOf(one, looks)} ${lettersOf(one)}`;
    };
    expect(seen({ urgency: "immediate" })).toBe("red !");
    expect(seen({ urgency: "immediate", old: true })).toBe("red !?");
    expect(seen({ urgency: "soon", old: true })).toBe("grey ?");
    expect(seen({ urgency: "soon" })).toBe("amber AB");
  });

  it("gives way to others, but not where somebody is in danger or chosen", () => {
    expect(nameOf({})?.getDeclutterMode()).toBe("declutter");
    expect(nameOf({ urgency: "immediate" })?.getDeclutterMode()).toBe("obstacle");
    expect(nameOf({ chosen: true })?.getDeclutterMode()).toBe("obstacle");
  });

  it("says which floor and how old", () => {
    expect(nameOf({})?.getText()).toBe("Ana");
    expect(nameOf({ floor: "floor 1", old: true })?.getText()).toBe("Ana, floor 1, 1 min old");
  });

  it("leaves others room: of a long name it says the beginning, and all that follows it", () => {
    const long = { name: "W".repeat(80), floor: "floor 1", old: true };
    expect(nameOf(long)?.getText()).toBe(`${"W".repeat(23)}…, floor 1, 1 min old`);
    expect(nameOf({ name: "Wolfeschlegel von Bergen" })?.getText()).toBe("Wolfeschlegel von Bergen");
  });
});

describe("the name at a pin", () => {
  const colours = { text: "#000000", halo: "#ffffff" } as Colours;
  const text = (chosen: boolean) =>
    pinLabelStyle({ t_ms: 0 } as PinView, "W".repeat(80), chosen, colours).getText();

  it("is no person's: it says that it is a pin, and gives way unless it was chosen", () => {
    expect(text(false)?.getText()).toBe(`Pin: ${"W".repeat(23)}…, start`);
    expect(text(false)?.getDeclutterMode()).toBe("declutter");
    expect(text(true)?.getDeclutterMode()).toBe("obstacle");
  });
});

describe("trailLines", () => {
  const walk: TrailPoint[] = [
    [0, 0, 0, 0],
    [1_000, 1, 0, 0],
    [2_000, 2, 5, 1],
    [3_000, 3, 5, 1],
    [60_000, 4, 5, 1],
    [61_000, 5, 5, 1],
  ];

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
