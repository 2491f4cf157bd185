import type { Picture } from "../live/picture";
import { displayName } from "../live/urgency";
import { take, tool } from "../plan/tools";
import type { PinView } from "../wire";
import { clockTime } from "../words";
import { Icon } from "./Icon";

/** All pins in words: meetings stand nowhere on the plan, and not everybody has a pointer. */
export function PinList({ picture }: { picture: Picture }) {
  const pins = picture.pins.value;
  if (pins.length === 0) return null;
  const conflicts = pins.filter((pin) => pin.state === "conflict").length;
  return (
    <details class="pin-list">
      <summary class={conflicts > 0 ? "conflict" : ""}>
        {conflicts > 0 && <Icon name="alarm" />} Pins {pins.length}
        {conflicts > 0 && `, ${conflicts} in conflict`}
      </summary>
      <ul>
        {pins.map((pin) => (
          <li key={pin.pin_id} class={pin.state}>
            <button
              type="button"
              aria-pressed={isChosen(pin)}
              onClick={() => take({ kind: "edit-pin", pinId: pin.pin_id })}
            >
              {said(pin, picture)}
              <small> {WORDS[pin.state] ?? pin.state}</small>
            </button>
          </li>
        ))}
      </ul>
    </details>
  );
}

const WORDS: Record<string, string> = {
  used: "used",
  waiting: "waits",
  conflict: "in conflict",
};

function isChosen(pin: PinView): boolean {
  const now = tool.value;
  return now?.kind === "edit-pin" && now.pinId === pin.pin_id;
}

/** "Ana here, 12:40", "Ana met Bo, 12:41", "Ana at beacon 7, start". */
function said(pin: PinView, picture: Picture): string {
  const name = (unitId: string) => {
    const unit = picture.unit(unitId)?.peek();
    return unit === undefined ? unitId : displayName(unit);
  };
  const what =
    pin.kind === "meeting"
      ? `${name(pin.unit_id)} met ${name(pin.other_id)}`
      : pin.other_id === ""
        ? `${name(pin.unit_id)} here`
        : `${name(pin.unit_id)} at ${pin.kind} ${pin.other_id}`;
  return `${what}, ${pin.t_ms === 0 ? "at the start" : clockTime(pin.t_ms).slice(0, 5)}`;
}
