import { useSignal } from "@preact/signals";
import { useRef } from "preact/hooks";

type OfList = { currentTarget: HTMLSelectElement };

/** For a select element whose choice has an effect.  Arrow keys pass other entries: by keyboard the
 * choice takes effect with Enter or when the element loses the focus, and Escape cancels it. */
export function useChosen(current: string, act: (chosen: string) => void) {
  const passed = useSignal<string | null>(null);
  const byKeys = useRef(false);
  const settle = () => {
    const chosen = passed.peek();
    passed.value = null;
    if (chosen !== null && chosen !== current) act(chosen);
  };
  return {
    value: passed.value ?? current,
    onPointerDown: () => void (byKeys.current = false),
    onKeyDown: (press: KeyboardEvent) => {
      byKeys.current = true;
      if (press.key === "Escape") passed.value = null;
      if (press.key !== "Enter" || passed.peek() === null) return;
      press.preventDefault(); // it would open the list
      settle();
    },
    onBlur: settle,
    onChange: ({ currentTarget }: OfList) => {
      const chosen = currentTarget.value;
      if (byKeys.current) {
        passed.value = chosen;
        return;
      }
      currentTarget.value = current; // until the station says that it is so
      act(chosen);
    },
  };
}
