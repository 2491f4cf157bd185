/** Texts by key, in the chosen language.  Whatever reads one while it is drawn is drawn anew in another. */
import { IntlMessageFormat } from "intl-messageformat";
import type { ComponentChild } from "preact";
import { type Key, type Message, type PartName, type DeferredPart, deferred, shown } from "./catalogue";
import { locale } from "./measures";
import type { Placeholders } from "./placeholders";

type Values<K extends Key, Value> = [Placeholders<Message<K>>] extends [never]
  ? []
  : [values: Record<Placeholders<Message<K>> & string, Value>];

/** The keys of texts without placeholders. */
export type PlainKey = {
  [K in Key]: [Placeholders<Message<K>>] extends [never] ? K : never;
}[Key];

/** A text; numbers for plurals are given as they are, all others as their words. */
export function t<K extends Key>(key: K, ...[values]: Values<K, string | number>): string {
  const message = messageOf(key);
  return values === undefined ? message : String(parsed(message).format(values));
}

/** The same with parts of the page in its places. */
export function rich<K extends Key>(key: K, ...[values]: Values<K, ComponentChild>): ComponentChild {
  const message = messageOf(key);
  return values === undefined ? message : parsed(message).format<ComponentChild>(values as Record<string, ComponentChild>);
}

/** The text for a code of the station, such as `still` in `activity`; a code of another version stays as
 * it is, with spaces. */
export function label(part: PartName, code: string): string {
  return knownLabel(part, code) ?? code.replaceAll(/[-_]/g, " ");
}

/** The same, or nothing for a code that has no text. */
export function knownLabel(part: PartName | DeferredPart, code: string): string | undefined {
  const catalogue: Partial<Record<PartName | DeferredPart, Readonly<Record<string, string>>>> =
    part in shown.value.catalogue ? shown.value.catalogue : deferred.value;
  return catalogue[part]?.[code];
}

/** The message for a code of the station with its values, or nothing for a code that has no text. */
export function knownMessage(
  part: PartName | DeferredPart,
  code: string,
  values: Record<string, string | number>,
): string | undefined {
  const message = knownLabel(part, code);
  return message === undefined ? undefined : String(parsed(message).format(values));
}

/** A label within a sentence; German keeps the capitals of its nouns. */
export function inSentence(words: string): string {
  return shown.value.language === "de" ? words : words.toLocaleLowerCase(locale());
}

function messageOf(key: Key): string {
  const dot = key.indexOf(".");
  const texts: Readonly<Record<string, string>> = shown.value.catalogue[key.slice(0, dot) as PartName];
  return texts[key.slice(dot + 1)] ?? key;
}

const formats = new Map<string, IntlMessageFormat>();

/** Parsed once for each language. */
function parsed(message: string): IntlMessageFormat {
  const tag = locale();
  const name = `${tag} ${message}`;
  const format =
    formats.get(name) ?? new IntlMessageFormat(message, tag, undefined, { ignoreTag: true });
  formats.set(name, format);
  return format;
}
