import { IntlMessageFormat } from "intl-messageformat";
import { afterEach, describe, expect, it } from "vitest";
import * as format from "../src/format";
import { type Catalogue, type Language, LANGUAGES, type PartName, type DeferredPart, type DeferredTexts, show, shown } from "../src/language/catalogue";
import * as de from "../src/language/de";
import * as deferred_de from "../src/language/de/deferred";
import * as en from "../src/language/en";
import * as deferred_en from "../src/language/en/deferred";
import * as fr from "../src/language/fr";
import * as deferred_fr from "../src/language/fr/deferred";
import { degrees, floorNames, length, metresOf, shownLength, speed, units } from "../src/language/measures";
import { label, rich, t } from "../src/language/translate";

const CATALOGUES: Record<Language, Catalogue & DeferredTexts> = {
  en: { ...en, ...deferred_en },
  de: { ...de, ...deferred_de },
  fr: { ...fr, ...deferred_fr },
};

interface Element {
  type: number;
  value?: string;
  options?: Record<string, { value: Element[] }>;
}

const LITERAL = 0;
const PLURAL_NUMBER = 7;

/** Every placeholder of a message once, with its kind: "count 6". */
function placeholders(elements: readonly Element[]): string[] {
  const found = elements.flatMap(({ type, value, options }) => {
    const within = Object.values(options ?? {}).flatMap((one) => placeholders(one.value));
    return type === LITERAL || type === PLURAL_NUMBER ? within : [`${value} ${type}`, ...within];
  });
  return [...new Set(found)].sort();
}

function parsed(message: string): Element[] {
  const format = new IntlMessageFormat(message, "en", undefined, { ignoreTag: true });
  return format.getAst() as Element[];
}

const PARTS = Object.keys(CATALOGUES.en) as (PartName | DeferredPart)[];

describe("the catalogues", () => {
  it.each(LANGUAGES.filter((one) => one !== "en"))("have the same keys and placeholders in %s", (language) => {
    const other = CATALOGUES[language];
    expect(Object.keys(other)).toEqual(PARTS);
    for (const part of PARTS) {
      const texts: Readonly<Record<string, string>> = other[part];
      expect(Object.keys(texts).sort(), part).toEqual(Object.keys(CATALOGUES.en[part]).sort());
      for (const [key, message] of Object.entries<string>(CATALOGUES.en[part])) {
        const theirs = texts[key] ?? "";
        expect(theirs.trim(), `${part}.${key}`).not.toBe("");
        expect(placeholders(parsed(theirs)), `${part}.${key}`).toEqual(placeholders(parsed(message)));
      }
    }
  });
});

describe("a text", () => {
  afterEach(async () => {
    await show("en");
    units.value = "metric";
    floorNames.value = "european";
  });

  it("comes in the chosen language, with its numbers", async () => {
    expect(t("forwarder.sent", { count: 12_345 })).toBe("12,345 events sent");
    await show("de");
    expect(t("forwarder.sent", { count: 12_345 })).toBe("12.345 Ereignisse gesendet");
    expect(format.plusMinus(2.14)).toBe("±\u00a02,1\u00a0m");
    expect(format.duration(185_000)).toBe("3\u00a0min 05\u00a0s");
    expect(format.bytes(1_500)).toBe("1,5\u00a0kB");
    expect(format.dateAndTime(new Date(2026, 0, 9, 8, 5).getTime())).toBe("09.01.2026, 08:05");
    await show("fr");
    expect(format.percent(0.64)).toBe("64\u00a0%");
    expect(format.linkText({ link: "lost", switched_off: false } as Parameters<typeof format.linkText>[0])).toBe(
      "Liaison perdue",
    );
  });

  it("is the one that was asked for last, whichever file comes first", async () => {
    await Promise.all([show("de"), show("fr"), show("en")]);
    expect(shown.value.language).toBe("en");
  });

  it("has parts of the page in its places", () => {
    const age = { type: "strong" };
    expect(rich("measure.ago", { age: age as never })).toEqual([age, " ago"]);
  });

  it("of a code that this console does not know is the code", () => {
    expect(label("activity", "stairs_up")).toBe("Stairs up");
    expect(label("activity", "moon_walking")).toBe("moon walking");
  });

  it("gives lengths, speeds and temperatures in feet and degrees Fahrenheit", () => {
    units.value = "imperial";
    expect([length(3.048), speed(0.3048), degrees(100), format.plusMinus(2.14)]).toEqual([
      "10\u00a0ft",
      "1.0\u00a0ft/s",
      "212\u00a0°F",
      "±\u00a07\u00a0ft",
    ]);
    expect(metresOf(shownLength(12.5))).toBeCloseTo(12.5, 9);
  });

  it("counts floors as Americans do", async () => {
    floorNames.value = "american";
    const names = () => [2, 1, 0, -1].map((floor) => [format.floorName(floor), format.shortFloor(floor)]);
    expect(names()).toEqual([
      ["3rd floor", "3"],
      ["2nd floor", "2"],
      ["1st floor", "1"],
      ["basement 1", "B1"],
    ]);
    await show("de");
    expect(names()[2]).toEqual(["1. Etage", "1"]);
    floorNames.value = "european";
    expect(names()[1]).toEqual(["1. Obergeschoss", "1"]);
  });
});
