import { useSignal } from "@preact/signals";
import { attempt, live, mayAct, namedIncident } from "../sessions";
import { dialogUnit } from "../uiState";
import * as api from "../api";
import {
  crewsOf,
  floorsOf,
  current,
  kindWord,
  LOCATE_HINT,
  newestFirst,
  notNotifiable,
  type Target,
} from "../live/commands";
import type { Picture } from "../live/picture";
import { nameAmong } from "../live/urgency";
import type { CommandView } from "../wire";
import { floorName } from "../format";
import { Deliveries } from "./Deliveries";
import { Dialog } from "./Dialog";
import { Icon } from "./Icon";
import { useSinglePress } from "./useGuardedPress";
import { fields } from "./useLoaded";

const SAYS: Record<api.CommandKind, string> = {
  evacuate: "Orders everyone out at once. Each member is asked to acknowledge it.",
  par_request: "Asks each member to answer. Only a person’s answer confirms a PAR.",
  text: "Each member is asked to acknowledge it.",
  locate: LOCATE_HINT,
};

const EVERYONE = "everyone";

/** Asks whom it is for before anything is sent, and shows what became of it. */
export function CommandDialog({ kind }: { kind: api.CommandKind }) {
  const sentHere = useSignal<readonly string[]>([]);
  const picture = live.value?.picture;
  if (picture === undefined) return null;
  const orders = current(picture.commands.value.values(), picture.incident.value);
  return (
    <Dialog title={kindWord(kind)}>
      {mayAct.value && (
        <CommandForm
          kind={kind}
          picture={picture}
          sent={({ command_id }) => (sentHere.value = [...sentHere.peek(), command_id])}
        />
      )}
      {newestFirst(orders)
        .filter((command) => isShown(command, kind, sentHere.value))
        .map((command) => (
          <Deliveries key={command.command_id} command={command} picture={picture} />
        ))}
    </Dialog>
  );
}

/** Under *Evacuate now* the ticks of another order, or of an evacuation that is over, would be taken
 * for this one's.  All orders of the incident stand under *Message*. */
function isShown(command: CommandView, kind: api.CommandKind, sentHere: readonly string[]): boolean {
  if (kind === "evacuate") {
    return command.kind === kind && (command.open || sentHere.includes(command.command_id));
  }
  return kind === "text" || command.kind === kind;
}

interface FormProps {
  kind: api.CommandKind;
  picture: Picture;
  sent: (command: CommandView) => void;
}

function CommandForm({ kind, picture, sent }: FormProps) {
  const about = dialogUnit.peek();
  const to = useSignal(about === null ? EVERYONE : `unit:${about}`);
  const once = useSinglePress();
  void picture.unitsChanged.value;
  const members = picture.allUnits().filter((unit) => unit.registered);
  const units = [...members, ...picture.unassignedUnits().filter((unit) => unit.registered)];
  const targets = new Map([
    [EVERYONE, everyoneWord(picture)],
    ...crewsOf(members).map((crew) => [`crew:${crew}`, crew] as const),
    ...floorsOf(members).map((floor) => [`floor:${floor}`, floorWord(floor)] as const),
    ...units.map((unit) => [`unit:${unit.unit_id}`, nameAmong(unit, units)] as const),
  ]);
  // Else the list would turn to its first entry, which is everyone.
  if (!targets.has(to.value)) targets.set(to.value, `${nameIn(to.value)} (nobody now)`);
  const target = targetOf(to.value);
  const unreachable = notNotifiable(target, "unit_id" in target ? units : members);
  return (
    <form
      class="row command-form"
      onSubmit={(event) => {
        const form = event.currentTarget;
        const { text = "" } = fields(event);
        const wanted = targetOf(to.peek());
        const incidentId = "unit_id" in wanted ? undefined : namedIncident();
        once(() =>
          attempt(api.sendCommand(kind, wanted, text, incidentId)).then(
            (command) => {
              if (!command) return;
              sent(command);
              clearText(form);
            },
          ),
        );
      }}
    >
      <p>{SAYS[kind]}</p>
      <label>
        To
        <select
          autofocus={kind !== "text"}
          value={to.value}
          onChange={(event) => (to.value = event.currentTarget.value)}
        >
          {[...targets].map(([target, name]) => (
            <option key={target} value={target}>
              {name}
            </option>
          ))}
        </select>
      </label>
      {kind === "text" && (
        <label class="long">
          Message
          <input name="text" required maxLength={120} autofocus />
        </label>
      )}
      <button class={kind === "evacuate" ? "danger" : "primary"}>
        {kind === "evacuate" ? "Evacuate now" : "Send"}
      </button>
      {/* Below the button, which many names would push out of sight. */}
      <p class="not-notifiable" aria-live="polite">
        {unreachable !== "" && <Icon name="bellOff" />}
        {unreachable}
      </p>
    </form>
  );
}

function everyoneWord(picture: Picture): string {
  const several = picture.choices.value.length > 0;
  return several ? `Everyone in ${picture.incident.value?.name}` : "Everyone";
}

function floorWord(floor: number): string {
  const name = floorName(floor);
  return `${name.charAt(0).toUpperCase()}${name.slice(1)}, and whose floor is not known`;
}

function clearText(form: HTMLFormElement): void {
  const text = form.elements.namedItem("text");
  if (text instanceof HTMLInputElement) text.value = "";
}

function targetOf(value: string): Target {
  const name = nameIn(value);
  if (value.startsWith("crew:")) return { crew: name };
  if (value.startsWith("floor:")) return { floor: Number(name) };
  return value.startsWith("unit:") ? { unit_id: name } : { everyone: true };
}

function nameIn(target: string): string {
  return target.slice(target.indexOf(":") + 1);
}
