import type { ComponentChildren } from "preact";
import { mayAct } from "../sessions";
import type { Picture } from "../live/picture";
import { displayName } from "../live/urgency";
import { take, type Tool } from "../plan/tools";
import type { PinView } from "../wire";
import { clockTime, floorName } from "../format";
import { listed } from "../language/measures";
import { label, t } from "../language/translate";
import { PanelActions } from "./PanelActions";

/** All pins and beacons as a list: meetings are not on the plan, and keyboard users have no pointer. */
export function PinList({ picture }: { picture: Picture }) {
  return (
    <section class="tool-panel pin-list" aria-label={t("pin.list")}>
      <h3>{t("pin.list")}</h3>
      <ul>
        {worstFirst(picture.pins.value).map((pin) => (
          <li key={pin.pin_id} class={pin.state}>
            <Words edit={{ kind: "edit-pin", pinId: pin.pin_id }}>
              {said(pin, picture)}
              <small> {label("pin", pin.state)}</small>
            </Words>
          </li>
        ))}
        {picture.beacons.value.map(({ beacon_id, label: beacon, floor }) => (
          <li key={`beacon ${beacon_id}`}>
            <Words edit={{ kind: "edit-beacon", beaconId: beacon_id }}>
              {t("pin.beacon", { label: beacon || beacon_id })}
              <small> {floorName(floor)}</small>
            </Words>
          </li>
        ))}
      </ul>
      <PanelActions />
    </section>
  );
}

/** A button for users who may change it. */
function Words({ edit, children }: { edit: Tool; children: ComponentChildren }) {
  if (!mayAct.value) return <span>{children}</span>;
  return (
    <button type="button" onClick={() => take(edit)}>
      {children}
    </button>
  );
}

/** Pins that need attention come first; the others in the order in which they were set. */
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
      ? t("pin.met", { name: name(pin.unit_id), other: name(pin.other_id) })
      : pin.other_id === ""
        ? t("pin.here", { name: name(pin.unit_id) })
        : t("pin.at", { name: name(pin.unit_id), place: `${pin.kind} ${pin.other_id}` });
  const when = pin.t_ms === 0 ? t("pin.at_start") : clockTime(pin.t_ms).slice(0, 5);
  const where = pin.floor === null ? "" : floorName(pin.floor);
  return listed([what, where, when, pin.note].filter((part) => part !== ""));
}
