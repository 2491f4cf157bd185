import { describe, expect, it } from "vitest";
import { dispatchOf, facts, offered, suggestedName, summary, unitWords } from "../src/live/dispatch";
import { dispatch } from "./fixtures";

describe("a dispatch", () => {
  it("is offered until it is dismissed or over", () => {
    const all = [
      dispatch("1"),
      dispatch("2", { is_dismissed: true }),
      dispatch("3", { has_ended: true }),
    ];
    expect(offered(all).map((one) => one.number)).toEqual(["1"]);
  });

  it("is found by its number, whether or not it has opened the incident", () => {
    const one = dispatch("1");
    expect(dispatchOf("1", null, [dispatch("2"), one])).toBe(one);
    expect(dispatchOf("3", null, [one])).toBeNull();
  });

  it("is told in a line", () => {
    expect(summary(dispatch("1"))).toBe("Structure fire, Main St 5, E12, L4");
    expect(summary(dispatch("1", { type: "", type_code: "69D6", address: "", units: [] }))).toBe("69D6");
    const bare = dispatch("1", { type: "", type_code: "", address: "", units: [] });
    expect(summary(bare)).toBe("nothing more is known");
    expect(suggestedName(bare)).toBe("Dispatch 1");
    expect(suggestedName(dispatch("1"))).toBe("Structure fire, Main St 5");
    expect(suggestedName(dispatch("1", { address: "x".repeat(200) }))).toHaveLength(80);
  });

  it("has no line for what is not known", () => {
    const known = Object.fromEntries(facts(dispatch("1", { called_ms: null, priority: "" })));
    expect(known).toEqual({
      Type: "Structure fire (69D6)",
      Address: "Main St 5",
      Position: "52.500000, 13.400000",
    });
  });

  it("names the units that the station knows, and those that it does not", () => {
    const sign = { call_sign: "E12", words: "Engine 12", crew: "Engine 12", unit_ids: ["FF-01"] };
    expect(unitWords(sign)).toBe("Engine 12 (E12): crew Engine 12, FF-01");
    const other = { call_sign: "HLF 20", words: "HLF 20", crew: "", unit_ids: [] };
    expect(unitWords(other)).toBe("HLF 20: not known at this station");
  });
});
