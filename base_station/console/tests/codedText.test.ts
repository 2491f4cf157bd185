/** Texts by the codes of the station, in every language. */
import { afterEach, describe, expect, test } from "vitest";
import { loadDeferred, show } from "../src/language/catalogue";
import { units } from "../src/language/measures";
import { codedText, codedTexts, preflightText, problemTexts, refusalText } from "../src/live/codedText";

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
    expect(codedText(FULL, ENGLISH)).toMatch(/^die Aufzeichnung kann nicht nach \/var\/log .*2,5/);
    await show("fr");
    expect(codedText(FULL, ENGLISH)).toMatch(/^le journal ne peut pas être écrit dans \/var\/log/);
  });

  test("without a code, or with one of another version, stays as the station wrote it", async () => {
    await show("de");
    expect(codedText(undefined, ENGLISH)).toBe(ENGLISH);
    expect(codedText({ code: "of-a-later-version", texts: {}, numbers: {} }, ENGLISH)).toBe(ENGLISH);
    expect(problemTexts({ problems: [ENGLISH] })).toEqual([ENGLISH]);
  });

  test("about an archive that does not answer has what was asked of it, and the error", async () => {
    const away = {
      code: "archive-bucket-away",
      texts: {
        archive: "s3://city/engine-7",
        what: "i1/catalogue.json cannot be read",
        "what:": "archive-cannot-read",
        "what:file": "i1/catalogue.json",
        error: "connection refused",
      },
      numbers: {},
    };
    await show("de");
    await loadDeferred();
    expect(codedText(away, "")).toMatch(
      /^Archiv s3:\/\/city\/engine-7: i1\/catalogue\.json ist nicht lesbar \(connection refused\)\. Nichts ist verloren/,
    );
    await show("fr");
    await loadDeferred();
    expect(codedText(away, "")).toMatch(/i1\/catalogue\.json est illisible .*Rien n’est perdu/);
  });

  test("has the words of a term and the plural of a number", async () => {
    const ending = {
      code: "certificate-expires",
      texts: { holder: "unit", name: "unit-3", command: "muster pki renew unit-3" },
      numbers: { days: 1 },
    };
    await show("de");
    expect(codedText(ending, "")).toBe(
      "Das Zertifikat des Geräts unit-3 läuft in 1 Tag ab: muster pki renew unit-3",
    );
  });

  test("names a field of a form, and a sensor, as the console does", async () => {
    await show("de");
    await loadDeferred();
    const fault = (field: string) => ({ code: "field-fault", texts: { field, fault: "is missing" }, numbers: {} });
    expect(codedText(fault("target.crew"), "")).toBe("Trupp: is missing");
    expect(codedText(fault("unit_ids.2"), "")).toBe("Geräte 3: is missing");
    expect(codedText(fault("of_a_later_version"), "")).toBe("of_a_later_version: is missing");
    const subject = { code: "check-subject-of", texts: { subject: "calibration", sensor: "foot" }, numbers: {} };
    expect(codedText(subject, "")).toBe("Kalibrierung von Fuß");
  });

  test("says the limit of a field in the chosen units", async () => {
    await show("de");
    await loadDeferred();
    const limit = (field: string, fault: string, most: number) => ({
      code: "field-fault",
      texts: { field, fault: "", "fault:": fault },
      numbers: { [fault === "field-too-low" ? "fault:least" : "fault:most"]: most },
    });
    expect(codedText(limit("par_interval_s", "field-too-low", 60), "")).toBe("PAR alle: muss mindestens 1\u00a0min 00\u00a0s sein");
    expect(codedText(limit("target.reach_m", "field-too-high", 100), "")).toBe("Reichweite: darf höchstens 100\u00a0m sein");
    expect(codedText(limit("plan_rotation_rad", "field-too-high", 2 * Math.PI), "")).toMatch(/360° sein$/);
    expect(codedText(limit("lat_deg", "field-too-high", 90), "")).toMatch(/höchstens 90° sein$/);
    expect(codedText(limit("position_rate_hz", "field-too-low", 0.1), "")).toMatch(/mindestens 0,1 Hz sein$/);
    expect(codedText(limit("days", "field-too-high", 3650), "")).toMatch(/höchstens 3\.650 sein$/);
    expect(codedText(limit("name", "field-too-long", 80), "")).toMatch(/höchstens 80 Zeichen/);
    units.value = "imperial";
    expect(codedText(limit("target.reach_m", "field-too-high", 100), "")).toMatch(/höchstens 328\u00a0ft sein$/);
    units.value = "metric";
  });

  test("has texts within it in the chosen language, too", async () => {
    const fault = {
      code: "fault-of",
      texts: {
        subject: "battery BAT0",
        "subject:": "device-battery",
        "subject:name": "BAT0",
        fault: "no reading: it was removed",
        "fault:": "no-reading",
        "fault:reason": "it was removed",
        "fault:reason:": "device-removed",
      },
      numbers: {},
    };
    await show("de");
    expect(codedText(fault, "battery BAT0: no reading: it was removed")).toBe(
      "Akku BAT0: kein Messwert: es wurde entfernt",
    );
  });

  test("says a long way in kilometres or miles", async () => {
    const far = { code: "import-far", texts: {}, numbers: { away_km: 103.2 } };
    await show("de");
    await loadDeferred();
    expect(codedTexts(["it begins 103 km away", "older"], [far])).toEqual([
      "sie beginnt 103\u00a0km vom Ort des Einsatzes entfernt",
      "older",
    ]);
  });

  test("of a foreign unit with a code of ours and other parameters stays as the unit wrote it", async () => {
    await show("de");
    expect(codedText({ code: "no-reading", texts: {}, numbers: {} }, "kaputt")).toBe("kaputt");
  });
});

describe("a refusal of the station", () => {
  const WRONG = { detail: "the place is 1200 m from the plan's building", code: "place-too-far", parameters: { away_m: 1200, most_m: 500 } };

  test("is composed in the chosen language from code and parameters", async () => {
    await show("de");
    expect(refusalText(WRONG)).toBe(WRONG.detail); // not fetched yet
    await loadDeferred();
    expect(refusalText(WRONG)).toMatch(/^Der Ort ist 1\.200.m vom Gebäude des Plans entfernt; höchstens 500.m sind/);
    expect(refusalText({ detail: "Name or password is wrong.", code: "login-wrong", parameters: {} })).toBe(
      "Name oder Passwort ist falsch.",
    );
    await show("fr");
    expect(refusalText(WRONG)).toBe(WRONG.detail); // not those of another language
  });

  test("of another version, or without a code, stays as the station wrote it", async () => {
    await show("de");
    await loadDeferred();
    expect(refusalText({ ...WRONG, code: "of-a-later-version" })).toBe(WRONG.detail);
    expect(refusalText({ ...WRONG, parameters: { other: 1 } })).toBe(WRONG.detail);
    expect(refusalText({ ...WRONG, parameters: "none" })).toBe(WRONG.detail);
    expect(refusalText({ detail: WRONG.detail })).toBe(WRONG.detail);
    expect(refusalText({ detail: WRONG.detail, code: "", parameters: {} })).toBe(WRONG.detail);
  });

  test("is none where something else answers", () => {
    expect(refusalText(null)).toBeUndefined();
    expect(refusalText("<html>")).toBeUndefined();
    expect(refusalText({ error: "bad gateway" })).toBeUndefined();
  });
});

describe("findings of a unit's check at its start", () => {
  const FOUND = {
    level: "warning",
    text: "temperature: the unit has no sensor; radio: weak",
    findings: ["temperature: the unit has no sensor", "radio: weak"],
    finding_codes: [
      {
        code: "check-finding",
        texts: {
          subject: "temperature",
          "subject:": "check-subject",
          "subject:subject": "temperature",
          text: "the unit has no sensor",
          "text:": "check-no-temperature",
        },
        numbers: {},
      },
      { code: "check-finding", texts: { subject: "radio", text: "weak" }, numbers: {} },
    ],
  } as const;

  test("are composed in the chosen language, and those of another version as they came", async () => {
    await show("de");
    await loadDeferred();
    expect(preflightText({ ...FOUND, findings: [...FOUND.findings], finding_codes: [...FOUND.finding_codes] })).toBe(
      "mit Warnungen: Temperatur: das Gerät hat keinen Sensor; radio: weak",
    );
  });

  test("are the English text where a station of an earlier version gives no codes", async () => {
    await show("en");
    expect(preflightText({ level: "failed", text: "battery: empty" })).toBe("not ready: battery: empty");
  });
});
