import type { ComponentChildren } from "preact";
import { mayAct } from "../sessions";
import type { Picture } from "../live/picture";
import { displayName } from "../live/urgency";
import { take, type Tool } from "../plan/tools";
import type { PinView } from "../wire";
import { clockTime, floorName } from "../format";
import { PanelActions } from "./PanelActions";

/** All pins and beacons in words: meetings stand nowhere on the plan, and not everybody has a pointer. */
export function PinList({ picture }: { picture: Picture }) {
  return (
    <section class="tool-panel pin-list" aria-label="Pins">
      <h3>Pins</h3>
      <ul>
        {worstFirst(picture.pins.value).map((pin) => (
          <li key={pin.pin_id} class={pin.state}>
            <Words edit={{ kind: "edit-pin", pinId: pin.pin_id }}>
              {said(pin, picture)}
              <small> {WORDS[pin.state] ?? pin.state}</small>
            </Words>
          </li>
        ))}
        {picture.beacons.value.map(({ beacon_id, label, floor }) => (
          <li key={`beacon ${beacon_id}`}>
            <Words edit={{ kind: "edit-beacon", beaconId: beacon_id }}>
              Beacon {label || beacon_id}
              <small> {floorName(floor)}</small>
            </Words>
          </li>
        ))}
      </ul>
      <PanelActions />
    </section>
  );
}

/** A button for who may change it. */
function Words({ edit, children }: { edit: Tool; children: ComponentChildren }) {
  if (!mayAct.value) return <span>{children}</span>;
  return (
    <button type="button" onClick={() => take(edit)}>
      {children}
    </button>
  );
}

const WORDS: Record<string, string> = {
  used: "used",
  waiting: "waits",
  conflict: "in conflict",
};

/** What somebody is to see to stands on top; the others in the order in which they were set. */
function worstFirst(pins: readonly PinView[]): PinView[] {
  const rank = (pin: PinView) => (pin.state === "conflict" ? 0 : 1);
  return [...pins].sort((one, other) => rank(one) - rank(other));
}

/** "Ana here, floor 1, 12:40, behind the lift", "Ana met Bo, 12:41", "Ana at beacon 7, at the start". */
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
  const where = pin.floor === null ? "" : floorName(pin.floor);
  return [what, where, when, pin.note].filter((part) => part !== "").join(", ");
}
