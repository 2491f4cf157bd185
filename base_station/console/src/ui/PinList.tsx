import { mayAct } from "../sessions";
import type { Picture } from "../live/picture";
import { displayName } from "../live/urgency";
import { take } from "../plan/tools";
import type { PinView } from "../wire";
import { clockTime } from "../words";
import { Ends } from "./Ends";

/** All pins in words: meetings stand nowhere on the plan, and not everybody has a pointer. */
export function PinList({ picture }: { picture: Picture }) {
  return (
    <section class="tool-panel pin-list" aria-label="Pins">
      <h3>Pins</h3>
      <ul>
        {picture.pins.value.map((pin) => (
          <li key={pin.pin_id} class={pin.state}>
            <PinWords pin={pin} picture={picture} />
          </li>
        ))}
      </ul>
      <Ends />
    </section>
  );
}

/** A button for who may change it. */
function PinWords({ pin, picture }: { pin: PinView; picture: Picture }) {
  const words = (
    <>
      {said(pin, picture)}
      <small> {WORDS[pin.state] ?? pin.state}</small>
    </>
  );
  if (!mayAct.value) return <span>{words}</span>;
  return (
    <button type="button" onClick={() => take({ kind: "edit-pin", pinId: pin.pin_id })}>
      {words}
    </button>
  );
}

const WORDS: Record<string, string> = {
  used: "used",
  waiting: "waits",
  conflict: "in conflict",
};

/** "Ana here, 12:40, behind the lift", "Ana met Bo, 12:41", "Ana at beacon 7, at the start". */
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
  const when = pin.t_ms === 0 ? "at the start" : clockTime(pin.t_ms).slice(0, 5);
  return [what, when, pin.note].filter((part) => part !== "").join(", ");
}
