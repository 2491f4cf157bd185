import { useSignal } from "@preact/signals";
import { inSentence, t } from "../language/translate";
import { useEffect } from "preact/hooks";
import { Confirm, useFocusBack } from "./Confirm";

interface Props {
  label: string;
  about?: string; // object of the action, where several buttons have the same label
  question: string;
  yes?: string; // where the label is too long to be repeated
  focused?: boolean; // initially: it replaces the pressed button
  onConfirm: (press: MouseEvent) => void;
}

/** A button of an action that cannot be undone: the first press only asks. */
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
        key={question} // changed content is another question
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
