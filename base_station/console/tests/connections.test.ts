/** Lines about connections with other systems. */
import { describe, expect, it } from "vitest";
import { loadDeferred, show } from "../src/language/catalogue";
import { forwarderLine } from "../src/live/connections";

describe("a connection with another system", () => {
  const county = {
    name: "county",
    kind: "tak",
    address: "tls://tak.test:8089",
    state: "connecting" as const,
    since_ms: null,
    sent: 1200,
    received: 30,
    refused: 2,
    text: "does not answer",
    text_code: { code: "tak-no-answer", texts: {}, numbers: {} },
  };

  it("says where it goes, how it stands and why", () => {
    expect(forwarderLine(county)).toBe(
      "TAK county (tls://tak.test:8089): not connected; 1,200 events sent; 30 received; 2 left out; does not answer",
    );
  });

  it("says why in the chosen language", async () => {
    await show("de");
    await loadDeferred();
    expect(forwarderLine(county)).toMatch(/antwortet nicht$/);
    await show("en");
  });

  it("says no reason where all is well", () => {
    const well = { ...county, state: "connected" as const, refused: 0, text: "", text_code: null };
    expect(forwarderLine(well)).toBe(
      "TAK county (tls://tak.test:8089): connected; 1,200 events sent; 30 received",
    );
  });
});
