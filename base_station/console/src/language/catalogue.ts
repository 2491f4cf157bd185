/** The texts of the console in the chosen language.  English is part of the page; another language is
 * fetched once it is chosen. */
import { effect, signal } from "@preact/signals";
import * as en from "./en";

export const LANGUAGES = ["en", "de", "fr"] as const;
export type Language = (typeof LANGUAGES)[number];

type English = typeof en;
export type PartName = keyof English;
/** A part of a catalogue has exactly the keys of its English one. */
export type Part<P extends PartName> = { readonly [K in keyof English[P]]: string };
export type Catalogue = { readonly [P in PartName]: Part<P> };

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

interface Shown {
  language: Language;
  catalogue: Catalogue;
}

/** Language and catalogue change together. */
export const shown = signal<Shown>({ language: "en", catalogue: en });

/** The last one that was asked for is shown, whichever file comes first.  Throws where a file does not come. */
let wanted: Language = "en";
export async function show(language: Language): Promise<void> {
  wanted = language;
  const catalogue = await FILES[language]();
  if (wanted === language) shown.value = { language, catalogue };
}

if (typeof document !== "undefined") {
  effect(() => {
    document.documentElement.lang = shown.value.language;
  });
}
