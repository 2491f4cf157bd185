import type { Signal } from "@preact/signals";
import { changeOf } from "../plan/anchor";
import type { AnchorView } from "../wire";
import { Confirm } from "./Confirm";

interface Props {
  shown: AnchorView;
  next: Signal<AnchorView | null>; // none: it is not asked any more
  onYes: (next: AnchorView) => void;
}

/** Whether another place is meant for a plan that has one: people move by it. */
export function ReplacePlace({ shown, next, onYes }: Props) {
  const asked = next.value;
  if (asked === null) return null;
  return (
    <Confirm
      question={`${changeOf(shown, asked)} Replace the place for everybody?`}
      yes="Yes, replace place"
      onYes={() => {
        next.value = null;
        onYes(asked);
      }}
      onNo={() => (next.value = null)}
    />
  );
}
