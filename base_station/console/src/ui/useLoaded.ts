import { useSignal, type Signal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { attempt, live } from "../sessions";

/** Requests at the start, and after a failure once the station is received again. */
export function useAsked(ask: () => void, isThere: () => boolean): void {
  const isHeard = live.value?.picture.link.value.kind === "up";
  useEffect(() => {
    if (!isThere()) ask();
  }, [isHeard]);
}

/** The answer of the station, and a function that requests it again. */
export function useLoaded<T>(load: () => Promise<T>): [Signal<T | null>, () => void] {
  const loaded = useSignal<T | null>(null);
  const again = () => {
    void attempt(load()).then((answer) => {
      if (answer !== null) loaded.value = answer;
    });
  };
  useAsked(again, () => loaded.peek() !== null);
  return [loaded, again];
}

/** The fields of a submitted form as trimmed text. */
export function fields(event: SubmitEvent): Record<string, string> {
  event.preventDefault();
  const form = new FormData(event.currentTarget as HTMLFormElement);
  return Object.fromEntries([...form].map(([name, value]) => [name, String(value).trim()]));
}
