import { describe, expect, it } from "vitest";
import type { Route } from "../src/api";
import { drawnRoute, others, ricOf, routeWords, wayWords } from "../src/live/rescue";
import { routeLines } from "../src/plan/routeLines";
import { unit } from "./fixtures";

const ROUTE: Route = {
  unit_id: "FF-02",
  known: true,
  distance_m: 37.6,
  uncertainty_m: 4.2,
  crosses_walls: false,
  text: "14 m to the stairs, up one floor, left, 9 m",
  next_text: "14 m to the stairs, up one floor",
  legs: [
    { turn: "ahead", bearing_rad: 0, distance_m: 14, floors: 1 },
    { turn: "left", bearing_rad: -1.57, distance_m: 9, floors: 0 },
  ],
  places: [
    { north_m: 0, east_m: 0, floor: 0 },
    { north_m: 14, east_m: 0, floor: 0 },
    { north_m: 14, east_m: 0, floor: 1 },
    { north_m: 14, east_m: -9, floor: 1 },
  ],
};

function member(unitId: string, crew: string) {
  const person = { person_id: unitId, name: unitId, crew, role: "", photo_url: null };
  return unit(unitId, { person });
}

describe("words of a way", () => {
  it("tells length and doubt, and a line as a line", () => {
    expect(wayWords(ROUTE)).toBe("38\u00a0m ± 4\u00a0m");
    expect(wayWords({ ...ROUTE, known: false })).toBe("38\u00a0m ± 4\u00a0m in a straight line");
    expect(routeWords(ROUTE)).toBe("14\u00a0m to the stairs, up one floor, left, 9\u00a0m");
    expect(routeWords({ ...ROUTE, known: false })).toBe(
      "no known way; 17\u00a0m to the north-west, up one floor",
    );
    const unturned = { turn: null, bearing_rad: Math.PI / 2, distance_m: 3.2, floors: -2 };
    expect(routeWords({ ...ROUTE, legs: [unturned] })).toBe("east, 3\u00a0m to the stairs, down 2 floors");
    expect(routeWords({ ...ROUTE, legs: [] })).toBe("beside you");
    expect(routeWords({ ...ROUTE, crosses_walls: true })).toContain("through a wall of the plan");
  });
});

describe("the way that is drawn", () => {
  it("is that of who was chosen, or of the nearest", () => {
    const far = { ...ROUTE, unit_id: "FF-03" };
    const all = { unitId: "FF-01", routes: [ROUTE, far], guides: [], fault: "" };
    expect(drawnRoute({ ...all, rescuerId: null })).toBe(ROUTE);
    expect(drawnRoute({ ...all, rescuerId: "FF-03" })).toBe(far);
    expect(drawnRoute({ ...all, routes: [], rescuerId: "FF-03" })).toBeNull();
  });

  it("has a line for each floor, strong on the one that is shown", () => {
    expect(routeLines(ROUTE, 1).map((one) => one.isHere)).toEqual([false, true]);
    expect(routeLines(ROUTE, "all").every((one) => one.isHere)).toBe(true);
    expect(routeLines(ROUTE, 0)[0]?.line.at(-1)).toEqual([0, 14]);
  });
});

describe("who can go", () => {
  const units = [member("FF-01", "RIC"), member("FF-02", "RIT 1"), member("FF-03", "Rick's crew")];

  it("has the rapid intervention crew by its name, without who is down", () => {
    expect(ricOf(units, "FF-01").map((one) => one.unit_id)).toEqual(["FF-02"]);
  });

  it("leaves out who has no position", () => {
    const nowhere = { ...member("FF-04", ""), position: null };
    expect(others([nowhere], "FF-01")).toEqual([]);
  });
});
