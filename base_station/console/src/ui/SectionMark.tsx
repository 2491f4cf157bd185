import type { DrawnMark } from "../section/markDrawing";
import { select } from "../uiState";
import { t } from "../language/translate";

/** As on the plan: in danger an octagon, soon a square on its corner, others round. */
const OUTLINES = {
  immediate: "M-7.5,-18h15L18,-7.5v15L7.5,18h-15L-18,7.5v-15z",
  soon: "M0,-20L20,0 0,20 -20,0z",
  watch: "M0,-17a17,17 0 1 0 .01,0z",
  normal: "M0,-17a17,17 0 1 0 .01,0z",
};

interface Props {
  mark: DrawnMark;
  isOpen: boolean; // the people of a number are listed
  press(): void;
}

/** One person, or a number of people. */
export function Mark({ mark, isOpen, press }: Props) {
  const several = mark.members.length > 1;
  const state = [mark.urgency, mark.chosen ? "chosen" : "", mark.old ? "old" : "", several ? "several" : ""];
  return (
    <>
      <button
        type="button"
        class={`section-mark ${state.filter((word) => word !== "").join(" ")}`}
        title={mark.words}
        aria-pressed={several ? undefined : mark.chosen}
        aria-expanded={several ? isOpen : undefined}
        style={{ left: `${mark.xPx}px`, top: `${mark.yPx}px` }}
        onClick={press}
      >
        <svg viewBox="-21 -21 42 42" aria-hidden="true" focusable="false">
          <path d={OUTLINES[mark.urgency]} />
        </svg>
        <span aria-hidden="true">{mark.letters}</span>
        <span class="spoken">{mark.words}</span>
      </button>
      {mark.name !== null && (
        <span
          class={`section-name ${mark.urgency} ${mark.chosen ? "chosen" : ""}`}
          aria-hidden="true"
          style={{ left: `${mark.name.xPx}px`, top: `${mark.name.yPx}px` }}
        >
          {mark.name.text}
        </span>
      )}
    </>
  );
}

/** The people of a number, each to be chosen. */
export function MarkMembers({ mark, close }: { mark: DrawnMark; close(): void }) {
  return (
    <div class="section-members">
      <ul aria-label={t("section.here")}>
        {mark.members.map(({ unitId, words }) => (
          <li key={unitId}>
            <button type="button" onClick={() => select(unitId, null)}>
              {words}
            </button>
          </li>
        ))}
      </ul>
      <button type="button" onClick={close}>
        {t("common.close")}
      </button>
    </div>
  );
}
