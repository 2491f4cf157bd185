import { useSignal } from "@preact/signals";
import type { JSX } from "preact";

interface Done {
  say: () => void;
  /** Called once the form's content has changed. */
  unsay: () => void;
  words: JSX.Element;
}

/** The word of success of a form whose work is to be seen nowhere else.  The place is there before the
 * words, so that a screen reader hears them. */
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
