import { useSignal } from "@preact/signals";

interface Props {
  label: string;
  question: string;
  onConfirm: () => void;
}

/** A button for what cannot be taken back: the first press only asks. */
export function ConfirmButton({ label, question, onConfirm }: Props) {
  const asked = useSignal(false);
  if (!asked.value) {
    return (
      <button type="button" onClick={() => (asked.value = true)}>
        {label}
      </button>
    );
  }
  return (
    <span class="confirm" role="group" aria-label={question}>
      {question}
      <button type="button" class="danger" onClick={onConfirm}>
        Yes, {label.toLowerCase()}
      </button>
      <button type="button" onClick={() => (asked.value = false)}>
        No
      </button>
    </span>
  );
}
