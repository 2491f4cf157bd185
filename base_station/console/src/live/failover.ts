/** Changes to the other station's console when this one's station is lost or no longer leads.  It has
 * another address, so the browser loads it; the picture here stays until the other one answers. */
import type { StandbyView } from "../wire";
import type { LinkState } from "./picture";
import type { Session } from "./session";
import * as api from "../api";
import { transferUrl } from "./loginTransfer";
import { Tickets } from "./tickets";

export const PATIENCE_MS = 4000;
const LOOK_EVERY_MS = 1000;
const ANSWER_MS = 3000;

export interface Standing {
  link: LinkState;
  standby: StandbyView | null;
  /** Whether this console has seen its station lead: a console of a standby stays. */
  led: boolean;
  nowMs: number; // by the clock of `link`
}

/** The console to go to as soon as that station leads; null: stay. */
export function wayOut({ link, standby, led, nowMs }: Standing): string | null {
  if (standby === null || !/^https?:\/\//.test(standby.other_url)) return null;
  const gone = link.kind === "down" && nowMs - link.sinceMs >= PATIENCE_MS;
  const replaced = link.kind === "up" && led && standby.role !== "active";
  return gone || replaced ? standby.other_url : null;
}

/** Watch over a session until the returned function is called. */
export function watchOver(session: Session, go: (url: string) => void): () => void {
  let led = false;
  let asking = false;
  const tickets = new Tickets(api.createLoginTicket);
  const look = async () => {
    const { link, health } = session.picture;
    const standby = health.peek()?.standby ?? null;
    led ||= standby?.role === "active";
    const leadsWithOther = standby?.role === "active" && standby.other_url !== "";
    if (leadsWithOther && link.peek().kind === "up") void tickets.renew(performance.now());
    const url = wayOut({ link: link.peek(), standby, led, nowMs: performance.now() });
    if (url === null || asking) return;
    asking = true;
    if (await leads(url)) go(transferUrl(standby?.station ?? "", url, tickets.latest));
    asking = false;
  };
  const timer = window.setInterval(() => void look(), LOOK_EVERY_MS);
  return () => window.clearInterval(timer);
}

async function leads(url: string): Promise<boolean> {
  try {
    const answer = await fetch(`${url}/api/v1/standby/leads`, {
      credentials: "omit",
      cache: "no-store",
      signal: AbortSignal.timeout(ANSWER_MS),
    });
    return ((await answer.json()) as { leads: boolean }).leads;
  } catch {
    return false;
  }
}
