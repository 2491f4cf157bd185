import { describe, expect, it } from "vitest";
import { arrival, wayFrom } from "../src/live/arrival";

describe("who comes from the other station's console", () => {
  it("is told so, and that the same login holds", () => {
    const url = new URL(wayFrom("the first & only", "https://second:8443"));
    expect(url.origin).toBe("https://second:8443");
    expect(arrival(url.hash)).toContain("“the first & only”");
    expect(arrival(url.hash)).toContain("same user and password");
  });

  it("is not invented", () => {
    expect(arrival("")).toBe("");
    expect(arrival("#else")).toBe("");
    expect(arrival("#from=%E0%A4%A")).toBe("");
    expect(arrival(`#from=${"x".repeat(500)}`).length).toBeLessThan(200);
  });
});
