import { describe, expect, it } from "vitest";
import { coordinatesIn, degreesIn } from "../src/plan/coordinates";

describe("both coordinates in one text", () => {
  it.each([
    "57.7, 11.9",
    "57.7,11.9",
    " 57.7 11.9 ",
    "57.7\t11.9",
    "57.7; 11.9",
    "57,7; 11,9",
    "57,7 11,9",
    "57,7, 11,9",
    "57,7,11,9",
    "57.7° N, 11.9° E",
    "57.7N 11.9E",
    "57,7°, 11,9°",
  ])("%s", (text) => {
    expect(coordinatesIn(text)).toEqual([57.7, 11.9]);
  });

  it("has south and west below zero", () => {
    expect(coordinatesIn("-33.9, −18.4")).toEqual([-33.9, -18.4]);
    expect(coordinatesIn("33.9 S 18.4 W")).toEqual([-33.9, -18.4]);
    expect(coordinatesIn("57, 11")).toEqual([57, 11]);
  });

  it.each(["57,7", "57.7", "", "57.7, 11.9, 3", "91, 11.9", "57.7, 181", "57.7 E, 11.9 N", "Mill Road 7", "1e1, 2"])(
    "is not in %j",
    (text) => {
      expect(coordinatesIn(text)).toBeNull();
    },
  );
});

describe("one coordinate", () => {
  it("has a decimal point or comma", () => {
    expect(degreesIn("57.7", "lat")).toBe(57.7);
    expect(degreesIn(" −57,7 °", "lat")).toBe(-57.7);
    expect(degreesIn("11.9 W", "lon")).toBe(-11.9);
    expect(degreesIn("0", "lon")).toBe(0);
  });

  it("is on the Earth", () => {
    expect(degreesIn("91", "lat")).toBeNull();
    expect(degreesIn("91", "lon")).toBe(91);
    expect(degreesIn("", "lat")).toBeNull();
    expect(degreesIn("57 north", "lat")).toBeNull();
  });
});
