import type { ComponentChildren } from "preact";
import { putDown } from "../plan/tools";

interface Props {
  label?: string | null; // of the button that sends; none: there is nothing to send
  children?: ComponentChildren;
}

/** The last row of a panel below the plan. */
export function Ends({ label = null, children }: Props) {
  return (
    <p class="ends">
      {label !== null && <button class="primary">{label}</button>}
      {children}
      <button type="button" onClick={putDown}>
        {label === null ? "Close" : "Cancel"}
      </button>
    </p>
  );
}
