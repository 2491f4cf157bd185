import { describe, expect, it } from "vitest";
import { arrivalNotice, ticketOf, transferUrl, withoutTicket } from "../src/live/loginTransfer";
import { Tickets } from "../src/live/tickets";

describe("who comes from the other station's console", () => {
  it("is told so, and that the same login holds", () => {
    const url = new URL(transferUrl("the first & only", "https://second:8443"));
    expect(url.origin).toBe("https://second:8443");
    expect(arrivalNotice(url.hash)).toContain("“the first & only”");
    expect(arrivalNotice(url.hash)).toContain("same user and password");
    expect(ticketOf(url.hash)).toBe("");
  });

  it("goes on with the ticket, which no server and no history sees", () => {
    const url = new URL(transferUrl("first&ticket=x", "https://second:8443", "a+b/c=&d"));
    expect(ticketOf(url.hash)).toBe("a+b/c=&d");
    expect(url.pathname + url.search).toBe("/");
    expect(arrivalNotice(url.hash)).toContain("“first&ticket=x”");
    expect(withoutTicket(url.hash)).not.toContain("a%2Bb");
    expect(arrivalNotice(withoutTicket(url.hash))).toBe(arrivalNotice(url.hash));
  });

  it("is not invented", () => {
    expect(arrivalNotice("")).toBe("");
    expect(arrivalNotice("#else")).toBe("");
    expect(arrivalNotice("#from=%E0%A4%A")).toBe("");
    expect(ticketOf("#ticket=x")).toBe("");
    expect(ticketOf("#from=a&ticket=%E0%A4%A")).toBe("");
    expect(withoutTicket("#else")).toBe("#else");
    expect(arrivalNotice(`#from=${"x".repeat(500)}`).length).toBeLessThan(200);
  });
});

describe("a ticket for the other station", () => {
  it("is asked for now and then, and kept while there is no newer one", async () => {
    const answers = ["one", null, "two"];
    let asked = 0;
    const tickets = new Tickets(() => {
      const ticket = answers[asked++] ?? null;
      return ticket === null ? Promise.reject(new Error("busy")) : Promise.resolve({ ticket });
    });
    const seen: string[] = [];
    for (const nowMs of [0, 1000, 119_000, 120_000, 121_000, 125_000, 126_000]) {
      await tickets.renew(nowMs);
      seen.push(`${asked} ${tickets.latest}`);
    }
    expect(seen).toEqual(["1 one", "1 one", "1 one", "2 one", "2 one", "3 two", "3 two"]);
  });
});
