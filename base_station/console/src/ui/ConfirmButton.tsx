import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { HASTE_MS } from "./haste";

interface Props {
  label: string;
  about?: string; // what it would be done to, where the label alone could be any of several
  question: string;
  focused?: boolean; // to begin with: it comes in place of what was pressed
  onConfirm: (press: MouseEvent) => void;
}

/** A button for what cannot be taken back: the first press only asks. */
export function ConfirmButton({ label, about = "", question, focused = false, onConfirm }: Props) {
  const state = useSignal<"at rest" | "asked" | "answered">("at rest");
  const askedMs = useRef(0);
  const next = useRef<HTMLButtonElement>(null);
  useEffect(() => {
    const lost = focused && document.activeElement === document.body;
    if (lost || state.value !== "at rest") next.current?.focus();
  }, [state.value]);
  if (state.value !== "asked") {
    const spoken = about === "" ? {} : { "aria-label": `${label}: ${about}` };
    return (
      <button
        type="button"
        class="asks"
        ref={next}
        {...spoken}
        onClick={() => {
          askedMs.current = performance.now();
          state.value = "asked";
        }}
      >
        {label}
      </button>
    );
  }
  const confirm = (press: MouseEvent) => {
    if (performance.now() - askedMs.current <= HASTE_MS) return;
    state.value = "answered";
    onConfirm(press);
  };
  return (
    <span class="confirm" role="group" aria-label={question}>
      {question}
      <button type="button" class="danger" onClick={confirm}>
        Yes, {label.toLowerCase()}
      </button>
      <button type="button" ref={next} onClick={() => (state.value = "answered")}>
        No
      </button>
    </span>
  );
}
