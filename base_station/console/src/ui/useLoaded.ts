import { useSignal, type Signal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { attempt } from "../sessions";

/** What the station answers, and a way to ask again. */
export function useLoaded<T>(load: () => Promise<T>): [Signal<T | null>, () => void] {
  const loaded = useSignal<T | null>(null);
  const again = () => {
    void attempt(load()).then((answer) => {
      if (answer !== null) loaded.value = answer;
    });
  };
  useEffect(again, []);
  return [loaded, again];
}

/** The fields of a submitted form as trimmed text. */
export function fields(event: SubmitEvent): Record<string, string> {
  event.preventDefault();
  const form = new FormData(event.currentTarget as HTMLFormElement);
  return Object.fromEntries([...form].map(([name, value]) => [name, String(value).trim()]));
}
