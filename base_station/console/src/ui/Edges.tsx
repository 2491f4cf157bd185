import type { ReadonlySignal } from "@preact/signals";
import { find } from "../uiState";
import type { Picture } from "../live/picture";
import { compassWord, type EdgeMark } from "../plan/edges";
import { t } from "../language/translate";

interface Props {
  picture: Picture;
  marks: ReadonlySignal<readonly EdgeMark[]>;
}

/** Arrows at the plan's edge towards members in danger outside the view; a press shows them. */
export function Edges({ picture, marks }: Props) {
  if (marks.value.length === 0) return null;
  const show = (unitId: string) => find(unitId, picture.unit(unitId)?.peek().position?.floor ?? null);
  return (
    <ul class="edges" aria-label={t("plan.outside_view")}>
      {marks.value.map(({ unitId, name, initials, at: [x, y], bearingRad }) => (
        <li key={unitId} style={{ left: `${x}px`, top: `${y}px` }}>
          <button
            type="button"
            title={t("plan.show", { name })}
            aria-label={t("plan.show_outside", { name, direction: compassWord(bearingRad) })}
            onClick={() => show(unitId)}
          >
            <span class="edge-arrow" style={{ rotate: `${bearingRad}rad` }} aria-hidden="true" />
            <span aria-hidden="true">{initials}</span>
          </button>
        </li>
      ))}
    </ul>
  );
}
