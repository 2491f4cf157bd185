import {
  commandWord,
  current,
  deliveryWord,
  lastLocate,
  newestFirst,
  openTo,
  shownState,
  type ShownState,
  type UnitCommand,
} from "../live/commands";
import type { Picture } from "../live/picture";
import type { UnitView } from "../wire";
import { t } from "../language/translate";
import { Icon, type IconName } from "./Icon";

const ICONS: Record<ShownState, IconName> = {
  queued: "clock",
  sent: "sent",
  received: "received",
  notified: "bell",
  acknowledged: "check",
  refused: "cross",
  expired: "cross",
  cannot_be_notified: "bellOff",
  ended: "cross",
};

/** State of a command at one member. */
export function CommandState({ command, delivery }: UnitCommand) {
  const state = shownState(command, delivery);
  return (
    <span class={`command-state ${state}`}>
      <Icon name={ICONS[state]} />
      {deliveryWord(command, delivery)}
    </span>
  );
}

interface Props {
  unit: UnitView;
  picture: Picture;
  chosen: boolean;
}

/** On a member's card: the open orders to the member; on the chosen one also the state of the last locate
 * order.  A PAR has its own mark, which also says what became of it. */
export function OpenCommands({ unit, picture, chosen }: Props) {
  const unitId = unit.unit_id;
  const commands = current(picture.commands.value.values(), picture.incident.value);
  const hasMark = unit.duty !== null;
  const open = openTo(unitId, newestFirst(commands)).filter(({ command }) => !(hasMark && command.kind === "par_request"));
  const located = chosen ? lastLocate(unitId, commands) : null;
  if (located !== null && !located.command.open) open.push(located);
  if (open.length === 0) return null;
  return (
    <ul class="card-commands" aria-label={t("order.open_to")}>
      {open.map(({ command, delivery }) => (
        <li key={command.command_id}>
          <span class="command-word">{commandWord(command)}</span>
          <CommandState command={command} delivery={delivery} />
        </li>
      ))}
    </ul>
  );
}
