import { useRef } from "preact/hooks";
import { MAX_ACT_MS } from "../http";

/** Two presses in haste are one. */
export const GUARD_MS = 500;

/** For a row of a list that others move in: a press in haste on what has only just come to this place
 * was meant for what stood here before.  Keys press what has the focus, which moves along.
 * `place`: where it stands, and what of it must not be another to whoever presses it.
 * `whenNew`: also while it has only just been there at all. */
export function useGuardedPress(place: number | string, whenNew = true): (act: () => void) => (press: MouseEvent) => void {
  const here = useRef({ place, sinceMs: whenNew ? performance.now() : -Infinity });
  if (here.current.place !== place) here.current = { place, sinceMs: performance.now() };
  return (act) => (press) => {
    const byKey = press.detail === 0;
    if (byKey || performance.now() - here.current.sinceMs > GUARD_MS) act();
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
