import { half, type Half } from "../view";
import { Icon, type IconName } from "./Icon";

const HALVES: readonly [Half, string, IconName][] = [
  ["people", "People", "people"],
  ["plan", "Plan", "floor"],
];

/** On a small screen: the list or the plan. */
export function Halves() {
  return (
    <div class="halves" role="group" aria-label="Shown">
      {HALVES.map(([one, word, icon]) => (
        <button
          key={one}
          type="button"
          aria-pressed={half.value === one}
          onClick={() => (half.value = one)}
        >
          <Icon name={icon} />
          {word}
        </button>
      ))}
    </div>
  );
}
