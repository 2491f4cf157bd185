/** Keeps a ticket ready with which the user continues at the other station if this one fails: after the
 * failure none can be requested. */
const RENEW_AFTER_MS = 120_000; // it lasts for ten minutes
const AGAIN_AFTER_MS = 5_000;

export class Tickets {
  private dueMs = -Infinity;
  latest = "";

  constructor(private readonly ask: () => Promise<{ ticket: string }>) {}

  /** Called periodically while this station leads and there is another one. */
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
