import type { Signal } from "@preact/signals";
import { changeOf } from "../plan/anchor";
import type { AnchorView } from "../wire";
import { t } from "../language/translate";
import { Confirm } from "./Confirm";

interface Props {
  shown: AnchorView;
  next: Signal<AnchorView | null>; // none: it is not asked any more
  onYes: (next: AnchorView) => void;
}

/** Confirmation of a new georeference for a plan that has one: it moves people. */
export function ReplacePlace({ shown, next, onYes }: Props) {
  const asked = next.value;
  if (asked === null) return null;
  return (
    <Confirm
      question={t("site.replace_question", { change: changeOf(shown, asked) })}
      yes={t("site.replace_yes")}
      onYes={() => {
        next.value = null;
        onYes(asked);
      }}
      onNo={() => (next.value = null)}
    />
  );
}
