/** Who comes from the console of the other station goes on there with the ticket that the address
 * carries.  It is another address, and browsers keep logins apart by address: without a ticket that is
 * still good they log in again, and are told why. */
import { t } from "../language/translate";

const FROM = "#from=";
const TICKET = "&ticket=";
const MAX_NAME_LENGTH = 40;

/** The other console's address, with a word for its login page; what is behind # is sent to nobody. */
export function transferUrl(station: string, url: string, ticket = ""): string {
  const shown = ticket === "" ? "" : TICKET + encodeURIComponent(ticket);
  return `${url}/${FROM}${encodeURIComponent(station)}${shown}`;
}

/** What the login page says to who came that way; empty: nobody did. */
export function arrivalNotice(hash: string): string {
  const from = originSentence(hash);
  return from === "" ? "" : t("login.same_here", { origin: from });
}

/** To who went on by a ticket, where the browser plays nothing yet: nobody need have pressed anything. */
export function arrivalSoundNotice(hash: string): string {
  return t("login.press_ok", { origin: originSentence(hash) }).trim();
}

function originSentence(hash: string): string {
  if (!hash.startsWith(FROM)) return "";
  const [station] = hash.slice(FROM.length).split(TICKET);
  const name = decoded(station).slice(0, MAX_NAME_LENGTH);
  return name === "" ? "" : t("login.came_from", { station: name });
}

/** What lets go on who came that way; empty: nothing does. */
export function ticketOf(hash: string): string {
  return hash.startsWith(FROM) ? decoded(hash.split(TICKET)[1]) : "";
}

/** The address without the ticket, which is good once. */
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
