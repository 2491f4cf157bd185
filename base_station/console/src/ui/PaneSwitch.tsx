import { pane, type Pane } from "../uiState";
import { Icon, type IconName } from "./Icon";

const PANES: readonly [Pane, string, IconName][] = [
  ["people", "People", "people"],
  ["plan", "Plan", "floor"],
];

/** On a small screen: the list or the plan. */
export function PaneSwitch() {
  return (
    <div class="halves" role="group" aria-label="Shown">
      {PANES.map(([one, word, icon]) => (
        <button
          key={one}
          type="button"
          aria-pressed={pane.value === one}
          onClick={() => (pane.value = one)}
        >
          <Icon name={icon} />
          {word}
        </button>
      ))}
    </div>
  );
}
