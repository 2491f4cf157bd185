/** Texts by the codes of the station, in every language. */
import { afterEach, describe, expect, test } from "vitest";
import { show } from "../src/language/catalogue";
import { codedText, problemTexts } from "../src/live/codedText";

const FULL = {
  code: "log-waits",
  texts: { folder: "/var/log", error: "No space left on device" },
  numbers: { waiting_mb: 2.5 },
};
const ENGLISH = "the log cannot be written to /var/log (No space left on device): 2.5 MB wait in memory";

afterEach(() => show("en"));

describe("a text of the station", () => {
  test("is composed in the chosen language from code and parameters", async () => {
    await show("de");
    expect(codedText("problem", FULL, ENGLISH)).toMatch(/^die Aufzeichnung kann nicht nach \/var\/log .*2,5/);
    await show("fr");
    expect(codedText("problem", FULL, ENGLISH)).toMatch(/^le journal ne peut pas être écrit dans \/var\/log/);
  });

  test("without a code, or with one of another version, stays as the station wrote it", async () => {
    await show("de");
    expect(codedText("problem", undefined, ENGLISH)).toBe(ENGLISH);
    expect(codedText("problem", { code: "of-a-later-version", texts: {}, numbers: {} }, ENGLISH)).toBe(ENGLISH);
    expect(problemTexts({ problems: [ENGLISH] })).toEqual([ENGLISH]);
  });

  test("has the words of a term and the plural of a number", async () => {
    const ending = {
      code: "certificate-expires",
      texts: { holder: "unit", name: "unit-3", command: "muster pki renew unit-3" },
      numbers: { days: 1 },
    };
    await show("de");
    expect(codedText("problem", ending, "")).toBe(
      "Das Zertifikat des Geräts unit-3 läuft in 1 Tag ab: muster pki renew unit-3",
    );
  });
});
