import {
  commandWord,
  newestFirst,
  openTo,
  shownState,
  stateWord,
  type ShownState,
} from "../live/commands";
import type { CommandView } from "../wire";
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
};

/** How far a command has got with somebody. */
export function CommandState({ state }: { state: ShownState }) {
  return (
    <span class={`command-state ${state}`}>
      <Icon name={ICONS[state]} />
      {stateWord(state)}
    </span>
  );
}

interface Props {
  unitId: string;
  commands: ReadonlyMap<string, CommandView>;
}

/** On a person's card: what is asked of this person now. */
export function OpenCommands({ unitId, commands }: Props) {
  const open = openTo(unitId, newestFirst(commands.values()));
  if (open.length === 0) return null;
  return (
    <ul class="card-commands" aria-label={t("order.open_to")}>
      {open.map(({ command, delivery }) => (
        <li key={command.command_id}>
          <span class="command-word">{commandWord(command)}</span>
          <CommandState state={shownState(command, delivery)} />
        </li>
      ))}
    </ul>
  );
}
