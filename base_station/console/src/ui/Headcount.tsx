import type { ReadonlySignal } from "@preact/signals";
import type { Headcount as Counts } from "../live/headcount";
import { PARTS } from "../live/headcount";
import type { Sought } from "../live/finding";
import { t } from "../language/translate";
import { part } from "./listState";

/** Number of members on scene, and by state; a press filters the list, and the next one shows all members
 * again. */
export function Headcount({ counts }: { counts: ReadonlySignal<Counts> }) {
  const { onScene, parts } = counts.value;
  return (
    <div class="headcount" role="group" aria-label={t("headcount.title")}>
      <Count of="on_scene" word={t("headcount.on_scene")} count={onScene} />
      {PARTS.map((one) => (
        <Count key={one} of={one} word={t(`headcount.${one}`)} count={parts[one]} />
      ))}
    </div>
  );
}

interface CountProps {
  of: NonNullable<Sought["part"]>;
  word: string;
  count: number;
}

function Count({ of, word, count }: CountProps) {
  const missing = (of === "not_located" || of === "never_heard") && count > 0;
  return (
    <button
      type="button"
      class={missing ? "missing" : ""}
      aria-pressed={part.value === of}
      onClick={() => (part.value = part.value === of ? null : of)}
    >
      <span>{word}</span> <strong>{count}</strong>
    </button>
  );
}
