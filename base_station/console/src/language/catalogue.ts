/** The texts of the console in the chosen language.  English is part of the page; another language is
 * fetched once it is chosen.  Texts that nobody sees at the start, such as refusals of the
 * station, are fetched after that. */
import { effect, signal } from "@preact/signals";
import * as en from "./en";
import type * as deferred_en from "./en/deferred";

export const LANGUAGES = ["en", "de", "fr"] as const;
export type Language = (typeof LANGUAGES)[number];

type English = typeof en;
type EnglishDeferred = typeof deferred_en;
type EnglishPart = English & EnglishDeferred;
export type PartName = keyof English;
export type DeferredPart = keyof EnglishDeferred;
/** A part of a catalogue has exactly the keys of its English one. */
export type Part<P extends keyof EnglishPart> = { readonly [K in keyof EnglishPart[P]]: string };
export type Catalogue = { readonly [P in PartName]: Part<P> };
export type DeferredTexts = { readonly [P in DeferredPart]: Part<P> };

export type Key = { [P in PartName]: `${P}.${keyof English[P] & string}` }[PartName];
/** The English message of a key, as the compiler knows it. */
export type Message<K extends Key> = K extends `${infer P extends PartName}.${infer Name}`
  ? Extract<English[P][Name & keyof English[P]], string>
  : never;

const FILES: Record<Language, () => Promise<Catalogue>> = {
  en: () => Promise.resolve(en),
  de: () => import("./de"),
  fr: () => import("./fr"),
};
const DEFERRED: Record<Language, () => Promise<DeferredTexts>> = {
  en: () => import("./en/deferred"),
  de: () => import("./de/deferred"),
  fr: () => import("./fr/deferred"),
};

interface Shown {
  language: Language;
  catalogue: Catalogue;
}

/** Language and catalogue change together. */
export const shown = signal<Shown>({ language: "en", catalogue: en });
/** Texts that are fetched after the page; nothing until then: the station's own English is shown meanwhile. */
export const deferred = signal<Partial<DeferredTexts>>({});

/** The last one that was asked for is shown, whichever file comes first.  Throws where a file does not come. */
let wanted: Language = "en";
export async function show(language: Language): Promise<void> {
  wanted = language;
  const catalogue = await FILES[language]();
  if (wanted !== language) return;
  if (shown.peek().language !== language) deferred.value = {};
  shown.value = { language, catalogue };
}

/** Deferred texts in the language that is shown.  Throws where the file does not come. */
export async function loadDeferred(): Promise<void> {
  const { language } = shown.peek();
  const texts = await DEFERRED[language]();
  if (shown.peek().language === language) deferred.value = texts;
}

if (typeof document !== "undefined") {
  effect(() => {
    document.documentElement.lang = shown.value.language;
  });
}
