import { useSignal, type ReadonlySignal } from "@preact/signals";
import { attempt } from "../sessions";
import { PAGE } from "../http";
import { useAsked } from "./useLoaded";

export interface Pages<T> {
  entries: ReadonlySignal<readonly T[]>; // the newest first
  loaded: ReadonlySignal<boolean>; // the station has answered
  older: (() => void) | null; // null: there are none
  again: () => void; // from the newest on
}

/** A list that grows without end: its newest page, and older ones when asked for. */
export function usePages<T>(
  load: (untilMs?: number) => Promise<T[]>,
  timeOf: (entry: T) => number,
): Pages<T> {
  const entries = useSignal<readonly T[]>([]);
  const loaded = useSignal(false);
  const ended = useSignal(true);
  const add = async (before: readonly T[]) => {
    const last = before.at(-1);
    const page = await attempt(load(last && timeOf(last)));
    if (page === null) return;
    entries.value = [...before, ...page];
    ended.value = page.length < PAGE;
    loaded.value = true;
  };
  const again = () => void add([]);
  useAsked(again, () => loaded.peek());
  return { entries, loaded, older: ended.value ? null : () => void add(entries.peek()), again };
}
