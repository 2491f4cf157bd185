import { pane, type Pane } from "../uiState";
import { type PlainKey, t } from "../language/translate";
import { Icon, type IconName } from "./Icon";

const PANES: readonly [Pane, PlainKey, IconName][] = [
  ["people", "menu.people", "people"],
  ["plan", "menu.plan", "floor"],
];

/** On a small screen: the list or the plan. */
export function PaneSwitch() {
  return (
    <div class="halves" role="group" aria-label={t("menu.shown")}>
      {PANES.map(([one, word, icon]) => (
        <button
          key={one}
          type="button"
          aria-pressed={pane.value === one}
          onClick={() => (pane.value = one)}
        >
          <Icon name={icon} />
          {t(word)}
        </button>
      ))}
    </div>
  );
}
