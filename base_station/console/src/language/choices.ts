/** The language, units and names of floors that this browser keeps. */
import { effect, signal } from "@preact/signals";
import { kept } from "../kept";
import { type Language, LANGUAGES, loadDeferred, show } from "./catalogue";
import { FLOOR_NAMES, floorNames, UNITS, units } from "./measures";

const CHOICES = ["browser", ...LANGUAGES] as const;
export type LanguageChoice = (typeof CHOICES)[number];
export const LANGUAGE_CHOICES: readonly LanguageChoice[] = CHOICES;

export const languageChoice = kept<LanguageChoice>("muster-language", CHOICES, "browser");
export const unitsChoice = kept("muster-units", UNITS, "metric");
export const floorsChoice = kept("muster-floors", FLOOR_NAMES, "european");

/** Whether the file of the chosen language did not come: the one before is still shown. */
export const languageMissing = signal(false);

/** The first of the browser's that the console has. */
function browsers(): Language {
  const codes = navigator.languages.map((tag) => tag.split("-")[0]);
  return codes.map((code) => LANGUAGES.find((one) => one === code)).find((one) => one !== undefined) ?? "en";
}

effect(() => {
  units.value = unitsChoice.value;
});

effect(() => {
  floorNames.value = floorsChoice.value;
});

const AGAIN_MS = 5_000;
/** A page that waits longer for its language is shown in English meanwhile. */
const PATIENCE_MS = 3_000;

/** Asks again for a file that did not come: the station may be away. */
async function follow(choice: LanguageChoice): Promise<void> {
  try {
    await show(choice === "browser" ? browsers() : choice);
    languageMissing.value = false;
    void followDeferred(choice);
  } catch (error) {
    console.warn(error);
    languageMissing.value = true;
    askAgain(choice, follow);
  }
}

/** Nothing is missing on the page without them: the station's own English is shown. */
async function followDeferred(choice: LanguageChoice): Promise<void> {
  try {
    await loadDeferred();
  } catch (error) {
    console.warn(error);
    askAgain(choice, followDeferred);
  }
}

function askAgain(choice: LanguageChoice, ask: (choice: LanguageChoice) => Promise<void>): void {
  setTimeout(() => choice === languageChoice.peek() && void ask(choice), AGAIN_MS);
}

/** Follows the choice from now on; done when the first one is shown. */
export async function useLanguage(): Promise<void> {
  let first: Promise<void> | undefined;
  languageChoice.subscribe((choice) => {
    const following = follow(choice);
    first ??= following;
  });
  await Promise.race([first, new Promise((done) => setTimeout(done, PATIENCE_MS))]);
}
