/** Has a ticket at hand with which the user goes on at the other station, should this one die: then
 * there is nobody left to ask for one. */
const RENEW_AFTER_MS = 120_000; // it lasts for ten minutes
const AGAIN_AFTER_MS = 5_000;

export class Tickets {
  private dueMs = -Infinity;
  latest = "";

  constructor(private readonly ask: () => Promise<{ ticket: string }>) {}

  /** Called again and again while this station leads and there is another one. */
  async renew(nowMs: number): Promise<void> {
    if (nowMs < this.dueMs) return;
    this.dueMs = nowMs + AGAIN_AFTER_MS;
    try {
      this.latest = (await this.ask()).ticket;
      this.dueMs = nowMs + RENEW_AFTER_MS;
    } catch {
      // The one before is good for a while, and this is tried again.
    }
  }
}
