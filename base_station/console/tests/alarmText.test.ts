import { afterEach, describe, expect, it } from "vitest";
import type { AlarmParametersView } from "../src/answers";
import { alarmLabel } from "../src/format";
import { LANGUAGES, show } from "../src/language/catalogue";
import * as en from "../src/language/en";
import { units } from "../src/language/measures";
import { alarmText } from "../src/live/alarmText";
import { alarm } from "./fixtures";

const FULL: AlarmParametersView = {
  member: "Ana",
  member_before: "Bo",
  unit_id: "FF-01",
  duration_s: 185,
  temperature_degc: 119.6,
  heat_fraction: 0.35,
  battery_fraction: 0.08,
  radius_m: 41.2,
  reasons: ["no-stance", "sample-gap"],
  fault: "its disk is full",
  part: "log",
  calibrated_s: 1_780_000_000,
};

function said(code: string, parameters: AlarmParametersView, text = "of the station"): string {
  return alarmText({ code, parameters, text });
}

afterEach(async () => {
  units.value = "metric";
  await show("en");
});

describe("the sentence of an alarm", () => {
  it.each(LANGUAGES)("is there for every code in %s, with all that it says", async (language) => {
    await show(language);
    for (const code of Object.keys(en.alarm_text)) {
      const sentence = said(code, FULL); // throws where the message wants another value
      expect(sentence, code).not.toBe("of the station");
      expect(sentence, code).not.toMatch(/[{}]|undefined|null/);
    }
  });

  it("comes in the chosen language and units", async () => {
    const heat = { member: "Ana", temperature_degc: 119.6, heat_fraction: 0.35 };
    expect(said("heat", heat)).toBe("Ana: equipment at 120\u00a0°C, heat limit 35\u00a0% used");
    await show("de");
    expect(said("heat", heat)).toBe("Ana: Ausrüstung bei 120\u00a0°C, Hitzegrenze zu 35\u00a0% ausgeschöpft");
    units.value = "imperial";
    await show("fr");
    expect(said("heat", heat)).toContain("équipement à 247\u00a0°F");
  });

  it("names who wore the unit before, reasons and faults", async () => {
    expect(said("mayday", { member: "Ana", member_before: "Bo" })).toBe("Mayday from Ana or, before, Bo");
    await show("de");
    expect(said("tracker-lost", FULL)).toContain("kein Tritt erkannt, Messwerte fehlen");
    expect(said("gps-unused", { member: "Ana", reasons: ["stuck"] })).toBe("Ana: GPS wird nicht verwendet (Empfänger hängt)");
    expect(said("tracker-unsure", { member: "Ana" })).toContain("ohne Angabe von Gründen");
  });

  it("is the station’s own where a log has none, or the code is of another version", async () => {
    await show("de");
    expect(said("", {}, "Ana may have fallen")).toBe("Ana may have fallen");
    expect(said("smoke-nearby", { member: "Ana" }, "Ana: smoke nearby")).toBe("Ana: smoke nearby");
  });
});

it("the short name of an alarm has the fault of the unit, whichever version the station has", async () => {
  const fault = { rule: "unit-fault", level: "fault", text: "Ana's unit: stuck" };
  expect(alarmLabel(alarm("a", { ...fault, parameters: { fault: "stuck" } }))).toBe("Unit fault: stuck");
  expect(alarmLabel(alarm("a", fault))).toBe("Unit fault: stuck");
  await show("de");
  expect(alarmLabel(alarm("a", { rule: "heat", level: "critical" }))).toBe("Hitze: kritisch");
  expect(alarmLabel(alarm("a", { rule: "smoke-nearby", level: "thick" }))).toBe("Smoke nearby: thick");
});
