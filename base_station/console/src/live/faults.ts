/** What cannot be shown, though the station said it: a part that fails takes no other along, and says
 * so where it would stand, or here where it stands nowhere. */
import { signal } from "@preact/signals";
import { t } from "../language/translate";

/** Sentences; the same one once. */
export const faults = signal<readonly string[]>([]);
const KEPT = 5;

export function cannotShow(what: string, error: unknown): string {
  const problem = error instanceof Error ? error.message : String(error);
  return t("common.cannot_show", { what, problem });
}

/** Do it; that it fails is said on the screen. */
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
