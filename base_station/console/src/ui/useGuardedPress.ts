import { useRef } from "preact/hooks";
import { MAX_ACT_MS } from "../http";
import { t } from "../language/translate";
import { confirmDone } from "../uiState";

/** Time in which a second press is ignored. */
export const GUARD_MS = 500;

/** For a row of a list whose order changes: a quick press on a row that has just moved here was meant for
 * the previous one.  The focus of the keyboard moves with the row.  `place`: position of the row, and
 * the content that must not have changed before a press.  `whenNew`: also for a row that has just
 * appeared. */
export function useGuardedPress(place: number | string, whenNew = true): (act: () => void) => (press: MouseEvent) => void {
  const here = useRef({ place, sinceMs: whenNew ? performance.now() : -Infinity });
  if (here.current.place !== place) here.current = { place, sinceMs: performance.now() };
  return (act) => (press) => {
    const byKey = press.detail === 0;
    if (byKey || performance.now() - here.current.sinceMs > GUARD_MS) act();
    else confirmDone(t("common.press_ignored"));
  };
}

/** Guard against a second press in haste, or before the station has answered. */
export function useSinglePress(): (act: () => Promise<unknown>) => void {
  const untilMs = useRef(-Infinity);
  return (act) => {
    if (performance.now() < untilMs.current) return;
    untilMs.current = performance.now() + MAX_ACT_MS;
    void act().then(() => (untilMs.current = performance.now() + GUARD_MS));
  };
}
