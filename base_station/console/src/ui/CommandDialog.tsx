import { useSignal } from "@preact/signals";
import { attempt, live, mayAct, namedIncident } from "../sessions";
import { dialogUnit } from "../uiState";
import * as api from "../api";
import {
  crewsOf,
  floorsOf,
  current,
  kindWord,
  newestFirst,
  notNotifiable,
  stands,
  type Target,
} from "../live/commands";
import { compareNames, listed, locale } from "../language/measures";
import type { Picture } from "../live/picture";
import { nameAmong } from "../live/urgency";
import type { CommandView } from "../wire";
import { floorName } from "../format";
import { type PlainKey, t } from "../language/translate";
import { Deliveries } from "./Deliveries";
import { Dialog } from "./Dialog";
import { Icon } from "./Icon";
import { OrderActions } from "./OrderActions";
import { useSinglePress } from "./useGuardedPress";
import { fields } from "./useLoaded";

const HINTS = {
  evacuate: "order.evacuate_hint",
  par_request: "order.par_hint",
  text: "order.text_hint",
  locate: "order.locate_hint",
} as const satisfies Record<api.CommandKind, PlainKey>;

const EVERYONE = "everyone";

/** Dialog for the recipients of a command, and its result. */
export function CommandDialog({ kind }: { kind: api.CommandKind }) {
  const sentHere = useSignal<readonly string[]>([]);
  const picture = live.value?.picture;
  if (picture === undefined) return null;
  const orders = current(picture.commands.value.values(), picture.incident.value);
  const sent = ({ command_id }: CommandView) => (sentHere.value = [...sentHere.peek(), command_id]);
  return (
    <Dialog title={kindWord(kind)}>
      {mayAct.value && (
        <CommandForm
          kind={kind}
          picture={picture}
          sent={sent}
        />
      )}
      {newestFirst(orders)
        .filter((command) => isShown(command, kind, sentHere.value))
        .map((command) => (
          <section key={command.command_id} class="order">
            <OrderActions command={command} sent={sent} />
            <Deliveries command={command} picture={picture} />
          </section>
        ))}
    </Dialog>
  );
}

/** Under *Evacuate now* answers to another order, or to an ended evacuation, would be taken for those to
 * this one.  An all clear is shown until all have answered it.  All orders of the incident are listed
 * under *Message*. */
function isShown(command: CommandView, kind: api.CommandKind, sentHere: readonly string[]): boolean {
  if (kind === "evacuate") {
    const isAllClear = command.kind === "all_clear";
    return stands(command) || (isAllClear && (command.open || sentHere.includes(command.command_id)));
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
  if (!targets.has(to.value)) targets.set(to.value, t("order.nobody_now", { name: nameIn(to.value) }));
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
      <p>{t(HINTS[kind])}</p>
      <label>
        {t("order.to")}
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
          {t("order.message")}
          <input name="text" required maxLength={120} autofocus />
        </label>
      )}
      <button class={kind === "evacuate" ? "danger" : "primary"}>
        {t(kind === "evacuate" ? "order.evacuate_now" : "order.send")}
      </button>
      {/* Below the button, which many names would push out of sight. */}
      <div class="not-notifiable" aria-live="polite">
        {unreachable !== null && (
          <>
            <Icon name="bellOff" />
            <Unreachable {...unreachable} />
          </>
        )}
      </div>
    </form>
  );
}

/** Above this number their names are folded. */
const MANY = 6;

function Unreachable({ words, names }: { words: string; names: readonly string[] }) {
  if (names.length === 0) return <span>{words}</span>;
  if (names.length <= MANY) return <span>{t("order.cannot_names", { cannot: words, names: listed(names) })}</span>;
  return (
    <details>
      <summary>{words}</summary>
      <p>{listed([...names].sort(compareNames))}</p>
    </details>
  );
}

function everyoneWord(picture: Picture): string {
  const several = picture.choices.value.length > 0;
  const incident = picture.incident.value?.name ?? "";
  return several ? t("order.everyone_in", { incident }) : t("order.everyone");
}

function floorWord(floor: number): string {
  const name = floorName(floor);
  return t("order.floor", { floor: name.charAt(0).toLocaleUpperCase(locale()) + name.slice(1) });
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
