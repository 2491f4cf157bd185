import type { ComponentChildren } from "preact";
import { putDown } from "../plan/tools";
import { t } from "../language/translate";
import { useFocusBack } from "./Confirm";

interface Props {
  label?: string | null; // of the button that sends; none: there is nothing to send
  question?: ComponentChildren; // in place of that button: whether it is meant
  children?: ComponentChildren;
}

/** The last row of a panel below the plan. */
export function PanelActions({ label = null, question = null, children }: Props) {
  const button = useFocusBack(question !== null);
  return (
    <p class="ends">
      {question ??
        (label !== null && (
          <button class="primary" ref={button}>
            {label}
          </button>
        ))}
      {children}
      <button type="button" onClick={putDown}>
        {t(label === null ? "menu.close" : "menu.cancel")}
      </button>
    </p>
  );
}
