/** Who comes from the console of the other station is told so where they log in again: it is another
 * address, and browsers keep logins apart by address. */

const FROM = "#from=";
const LONGEST = 40;

/** The other console's address, with a word for its login page. */
export function wayFrom(station: string, url: string): string {
  return `${url}/${FROM}${encodeURIComponent(station)}`;
}

/** What the login page says to who came that way; empty: nobody did. */
export function arrival(hash: string): string {
  if (!hash.startsWith(FROM)) return "";
  let station: string;
  try {
    station = decodeURIComponent(hash.slice(FROM.length)).slice(0, LONGEST);
  } catch {
    return ""; // somebody changed the address
  }
  return `You come from the console of the station “${station}”. The same user and password hold here.`;
}
