import { describe, expect, it } from "vitest";
import { actionWord, detailWords } from "../src/audit";
import { dateAndTime } from "../src/format";

const AT_MS = Date.UTC(2026, 10, 23, 20, 35);
const NAMES = new Map([["26ab024f9849922c", "Elena Rossi"]]);

function words(detail: object | string): string {
  return detailWords(typeof detail === "string" ? detail : JSON.stringify(detail), NAMES);
}

describe("the audit log", () => {
  it("says what was done as a sentence begins", () => {
    expect(actionWord("AcknowledgeAlarm")).toBe("Acknowledge alarm");
    expect(actionWord("CheckIn")).toBe("PAR confirmed by radio");
  });

  it.each([
    [
      { command_id: "08a1", kind: 2, unit_id: "", everyone: true, text: "", lasts_s: 600 },
      "PAR, everyone, lasts 10\u00a0min 00\u00a0s",
    ],
    [
      { unit_id: "FF-05", north_m: -6, east_m: 4.04, down_m: 0, std_m: 1, heading_std_rad: 0.2 },
      "FF-05, north -6\u00a0m, east 4\u00a0m, down 0\u00a0m, ± 1\u00a0m, ± of heading 11.5°",
    ],
    [
      {
        pin_id: "17",
        unit_id: "FF-05",
        t_ns: 0,
        north_m: 0,
        east_m: 4,
        std_m: 1,
        floor: 0,
        heading_rad: null,
        heading_std_rad: 0.35,
        note: "",
      },
      "FF-05, where the path begins, north 0\u00a0m, east 4\u00a0m, ± 1\u00a0m, ground floor",
    ],
    [{ beacon_id: "7", floor: -1, reach_m: 0 }, "beacon id: 7, basement 1, reach 0\u00a0m"],
    [
      { lat_deg: 0, lon_deg: 0, height_m: 0, plan_rotation_rad: 0 },
      "lat 0°, lon 0°, height 0\u00a0m, plan rotation 0°",
    ],
    [{ name: "Mill Road", par_interval_s: 0, work_limit_s: 0 }, "name: Mill Road"],
    [{ kind: 2, unit_id: "FF-01", position_rate_hz: 0 }, "PAR, FF-01"],
    [{ unit_id: "", crew: "", everyone: true, check_in_id: "8f" }, "everyone"],
    [{ entry_id: "8f", unit_id: "FF-01" }, "FF-01"],
    [{ incident_id: "i", despite_alarm_ids: [], despite_unit_ids: [] }, ""],
    [
      { incident_id: "i", despite_alarm_ids: ["fall:FF-01:5"], despite_unit_ids: ["FF-01", "FF-02"] },
      "despite alarm ids: fall:FF-01:5, despite unit ids: FF-01 FF-02",
    ],
    [{ unit_id: "FF-05", t_ns: 1e6 * AT_MS }, `FF-05, at ${dateAndTime(AT_MS)}`],
    [{ station: "engine-2", after_t_ns: 0, after_count: 0 }, "station: engine-2, after count 0"],
    [{ thresholds: { "heat.caution_degc": 0 } }, "heat caution 0\u00a0°C"],
    [{ unit_id: "FF-01", resting: false }, "FF-01, return to duty"],
    [{ unit_ids: ["FF-01", "FF-02"], pin_id: "17" }, "FF-01 FF-02"],
    [{ pin_id: "17", unit_id: "FF-01", other_unit_id: "FF-02" }, "FF-01, same place as FF-02"],
    [
      { unit_id: "FF-05", person_id: "26ab", person_name: "Elena Rossi", crew: "Rescue 3", role: "" },
      "FF-05, person name: Elena Rossi, crew: Rescue 3",
    ],
    [
      { thresholds: { "no-motion.alarm_s": 25, "heat.caution_degc": 80, "battery.low": 0.2 } },
      "no-motion alarm 25\u00a0s, heat caution 80\u00a0°C, battery low 0.2",
    ],
    [{ thresholds: {} }, "all default"],
    [{ alarm_id: "fall:1:2", note: "", last_raised_ms: 0 }, "alarm id: fall:1:2"],
    [
      { alarm_id: "fall:1:2", last_raised_ms: 1_700_000_000_000 },
      `alarm id: fall:1:2, last raised ${dateAndTime(1_700_000_000_000)}`,
    ],
  ])("says %o in words", (detail, text) => {
    expect(words(detail)).toBe(text);
  });

  it("says a person by name while there is one", () => {
    expect(words("26ab024f9849922c")).toBe("Elena Rossi");
    expect(words("26ab024f9849922c Elena Rossi")).toBe("Elena Rossi");
    expect(words("26ab024f9849922c Lena Rossi")).toBe("Lena Rossi");
    expect(words("mia as viewer")).toBe("mia as viewer");
  });
});
