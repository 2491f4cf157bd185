import { useSignal } from "@preact/signals";
import type { JSX } from "preact";

interface Done {
  say: () => void;
  /** Called once the form's content has changed. */
  unsay: () => void;
  words: JSX.Element;
}

/** Success message of a form without another visible effect.  Its element exists before the text, so that
 * screen readers announce it. */
export function useDone(sentence: string): Done {
  const isDone = useSignal(false);
  return {
    say: () => (isDone.value = true),
    unsay: () => (isDone.value = false),
    words: (
      <span class="done" role="status">
        {isDone.value && sentence}
      </span>
    ),
  };
}
