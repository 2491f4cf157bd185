import { useSignal } from "@preact/signals";
import { inSentence, t } from "../language/translate";
import { useEffect } from "preact/hooks";
import { Confirm, useFocusBack } from "./Confirm";

interface Props {
  label: string;
  about?: string; // what it would be done to, where the label alone could be any of several
  question: string;
  yes?: string; // where the label is too long to be said again
  focused?: boolean; // to begin with: it comes in place of what was pressed
  onConfirm: (press: MouseEvent) => void;
}

/** A button for what cannot be taken back: the first press only asks. */
export function ConfirmButton({
  label,
  about = "",
  question,
  yes = t("common.yes", { action: inSentence(label) }),
  focused = false,
  onConfirm,
}: Props) {
  const asked = useSignal(false);
  const button = useFocusBack(asked.value);
  useEffect(() => {
    if (focused && document.activeElement === document.body) button.current?.focus();
  }, []);
  if (asked.value) {
    return (
      <Confirm
        key={question} // what has changed since is another question
        question={question}
        yes={yes}
        onYes={(press) => {
          asked.value = false;
          onConfirm(press);
        }}
        onNo={() => (asked.value = false)}
      />
    );
  }
  const spoken = about === "" ? {} : { "aria-label": t("common.about", { action: label, what: about }) };
  return (
    <button type="button" class="asks" ref={button} {...spoken} onClick={() => (asked.value = true)}>
      {label}
    </button>
  );
}
