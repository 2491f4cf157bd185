/// <reference types="vite/client" />
import { describe, expect, it } from "vitest";
import sheet from "../src/styles/colours.css?raw";

/** WCAG 2.2, 1.4.3 (AA) for text, and 1.4.11 for what is drawn. */
const TEXT = 4.5;
const DRAWN = 3;

const GROUNDS = ["ground", "surface", "raised"];
const ON_ALL_GROUNDS = ["text", "quiet", "immediate", "soon", "watch", "normal", "accent"];
const TEXT_PAIRS: readonly (readonly [text: string, ground: string])[] = [
  ...ON_ALL_GROUNDS.flatMap((text) => GROUNDS.map((ground) => [text, ground] as const)),
  ["on-accent", "accent"],
  ["on-immediate", "immediate"],
  ["on-soon", "soon-fill"],
  ["on-replay", "replay"],
  ["ground", "text"], // a notice
  ["text", "room"], // names on the plan
  ["text", "stairs"],
];

type Rgb = readonly [red: number, green: number, blue: number];

function themes(): Map<string, Map<string, Rgb>> {
  const found = new Map<string, Map<string, Rgb>>();
  for (const [, name = "", body = ""] of sheet.matchAll(/data-theme="(\w+)"\] \{([^}]*)\}/g)) {
    const tokens = [...body.matchAll(/--([\w-]+): #(\w{6});/g)];
    found.set(name, new Map(tokens.map(([, token = "", hex = ""]) => [token, rgb(hex)])));
  }
  return found;
}

function rgb(hex: string): Rgb {
  const [red, green, blue] = [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
  return [red ?? NaN, green ?? NaN, blue ?? NaN];
}

/** Relative luminance of sRGB, as WCAG 2.2 defines it. */
function luminance(colour: Rgb | undefined): number {
  if (colour === undefined) return NaN;
  const [red, green, blue] = colour.map((one) =>
    one <= 0.04045 ? one / 12.92 : ((one + 0.055) / 1.055) ** 2.4,
  ) as unknown as Rgb;
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

function contrast(a: Rgb | undefined, b: Rgb | undefined): number {
  const [la, lb] = [luminance(a), luminance(b)];
  return (Math.max(la, lb) + 0.05) / (Math.min(la, lb) + 0.05);
}

it("there are three themes, with the same colours", () => {
  const all = themes();
  expect([...all.keys()]).toEqual(["light", "dark", "red"]);
  const names = [...all.values()].map((tokens) => [...tokens.keys()]);
  expect(names[1]).toEqual(names[0]);
  expect(names[2]).toEqual(names[0]);
});

describe.each([...themes()])("in the %s theme", (name, tokens) => {
  it("text can be read on its ground", () => {
    const poor = TEXT_PAIRS.map(
      ([text, ground]) => [text, ground, contrast(tokens.get(text), tokens.get(ground))] as const,
    ).filter(([, , ratio]) => !(ratio >= TEXT));
    expect(poor).toEqual([]);
  });

  it("walls, and who is chosen, are seen on the plan", () => {
    for (const drawn of ["wall", "chosen"]) {
      for (const ground of ["ground", "room"]) {
        expect(contrast(tokens.get(drawn), tokens.get(ground)), `${drawn} on ${ground}`).toBeGreaterThanOrEqual(DRAWN);
      }
    }
  });

  it("red light is of no other colour", () => {
    const other = [...tokens].filter(([, [, green, blue]]) => green + blue > 0).map(([token]) => token);
    if (name === "red") expect(other).toEqual([]);
    else expect(other).not.toEqual([]);
  });
});
