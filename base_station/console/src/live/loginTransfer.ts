/** Transfer of a login from the other station's console by the ticket in the address.  Browsers keep
 * logins apart by address: without a valid ticket the user logs in again, and sees the reason. */
import { t } from "../language/translate";

const FROM = "#from=";
const TICKET = "&ticket=";
const MAX_NAME_LENGTH = 40;

/** The other console's address, with a note for its login page; the part behind # is not sent to any
 * server. */
export function transferUrl(station: string, url: string, ticket = ""): string {
  const shown = ticket === "" ? "" : TICKET + encodeURIComponent(ticket);
  return `${url}/${FROM}${encodeURIComponent(station)}${shown}`;
}

/** Text of the login page for a transferred user; empty: there is none. */
export function arrivalNotice(hash: string): string {
  const from = originSentence(hash);
  return from === "" ? "" : t("login.same_here", { origin: from });
}

/** Notice after a transfer while the browser still blocks sound: no control was pressed yet. */
export function arrivalSoundNotice(hash: string): string {
  return t("login.press_ok", { origin: originSentence(hash) }).trim();
}

function originSentence(hash: string): string {
  if (!hash.startsWith(FROM)) return "";
  const [station] = hash.slice(FROM.length).split(TICKET);
  const name = decoded(station).slice(0, MAX_NAME_LENGTH);
  return name === "" ? "" : t("login.came_from", { station: name });
}

/** Ticket of the transferred user; empty: there is none. */
export function ticketOf(hash: string): string {
  return hash.startsWith(FROM) ? decoded(hash.split(TICKET)[1]) : "";
}

/** The address without the ticket, which is valid once. */
export function withoutTicket(hash: string): string {
  return hash.startsWith(FROM) ? (hash.split(TICKET)[0] ?? "") : hash;
}

function decoded(text: string | undefined): string {
  try {
    return decodeURIComponent(text ?? "");
  } catch {
    return ""; // somebody changed the address
  }
}
