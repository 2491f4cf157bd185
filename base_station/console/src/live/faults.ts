/** Parts of the picture that cannot be shown: a failing part affects no other; it is reported in its
 * place, or here if it has none. */
import { signal } from "@preact/signals";
import { t } from "../language/translate";

/** Sentences without repetition. */
export const faults = signal<readonly string[]>([]);
const KEPT = 5;

export function cannotShow(what: string, error: unknown): string {
  const problem = error instanceof Error ? error.message : String(error);
  return t("common.cannot_show", { what, problem });
}

/** Runs the function; a failure is shown on the screen. */
export function guarded(what: string | (() => string), work: () => void): boolean {
  try {
    work();
    return true;
  } catch (error) {
    console.error(error);
    report(cannotShow(typeof what === "string" ? what : what(), error));
    return false;
  }
}

export function report(sentence: string): void {
  if (faults.peek().includes(sentence)) return;
  faults.value = [...faults.peek(), sentence].slice(-KEPT);
}
