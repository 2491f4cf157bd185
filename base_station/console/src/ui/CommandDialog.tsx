import { useSignal } from "@preact/signals";
import { attempt, live, mayAct } from "../sessions";
import { dialogUnit } from "../view";
import * as api from "../api";
import { commandWord, crewsOf, kindWord, newestFirst, type Target } from "../live/commands";
import type { Picture } from "../live/picture";
import { nameAmong } from "../live/urgency";
import type { CommandView, DeliveryView } from "../wire";
import { clockTime } from "../words";
import { CommandState } from "./CommandState";
import { Dialog } from "./Dialog";
import { useOnce } from "./haste";
import { fields } from "./useLoaded";

const SAYS: Record<api.CommandKind, string> = {
  evacuate: "Tells them to get out at once. Each wearer is asked to acknowledge it.",
  par_request: "Asks each wearer to answer. Nothing but a person’s answer completes it.",
  text: "Each wearer is asked to acknowledge it.",
  locate: "The unit makes itself heard and seen.",
};

const EVERYONE = "everyone";

/** Asks whom it is for before anything is sent, and shows what became of it. */
export function CommandDialog({ kind }: { kind: api.CommandKind }) {
  const picture = live.value?.picture;
  if (picture === undefined) return null;
  return (
    <Dialog title={kindWord(kind)}>
      {mayAct.value && <CommandForm kind={kind} picture={picture} />}
      {newestFirst(picture.commands.value.values()).map((command) => (
        <Deliveries key={command.command_id} command={command} picture={picture} />
      ))}
    </Dialog>
  );
}

function CommandForm({ kind, picture }: { kind: api.CommandKind; picture: Picture }) {
  const about = dialogUnit.peek();
  const to = useSignal(about === null ? EVERYONE : `unit:${about}`);
  const once = useOnce();
  const units = picture.unitIds.value
    .map((unitId) => picture.unit(unitId)?.value)
    .filter((unit) => unit !== undefined)
    .filter((unit) => unit.registered);
  const targets = new Map([
    [EVERYONE, "Everyone"],
    ...crewsOf(units).map((crew) => [`crew:${crew}`, crew] as const),
    ...units.map((unit) => [`unit:${unit.unit_id}`, nameAmong(unit, units)] as const),
  ]);
  // Else the list would turn to its first entry, which is everyone.
  if (!targets.has(to.value)) targets.set(to.value, `${nameIn(to.value)} (nobody now)`);
  return (
    <form
      class="row command-form"
      onSubmit={(event) => {
        const form = event.currentTarget;
        const { text = "" } = fields(event);
        once(() =>
          attempt(api.sendCommand(kind, targetOf(to.peek()), text)).then(
            (command) => command && clearText(form),
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
    </form>
  );
}

function clearText(form: HTMLFormElement): void {
  const text = form.elements.namedItem("text");
  if (text instanceof HTMLInputElement) text.value = "";
}

function targetOf(value: string): Target {
  const name = nameIn(value);
  if (value.startsWith("crew:")) return { crew: name };
  return value.startsWith("unit:") ? { unit_id: name } : { everyone: true };
}

function nameIn(target: string): string {
  return target.slice(target.indexOf(":") + 1);
}

function Deliveries({ command, picture }: { command: CommandView; picture: Picture }) {
  return (
    <table class="deliveries stacked">
      <caption>
        {commandWord(command)} ({clockTime(command.issued_ms)}, {command.issued_by})
      </caption>
      <thead class="spoken">
        <tr>
          <th scope="col">Who</th>
          <th scope="col">State</th>
          <th scope="col">By whom and when</th>
        </tr>
      </thead>
      <tbody>
        {command.units.map((delivery) => (
          <tr key={delivery.unit_id}>
            <th scope="row">{nameOf(delivery.unit_id, picture)}</th>
            <td>
              <CommandState state={delivery.state} />
            </td>
            <td>
              <Answer command={command} delivery={delivery} />
            </td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

function nameOf(unitId: string, picture: Picture): string {
  const unit = picture.unit(unitId)?.value;
  return unit === undefined ? unitId : nameAmong(unit, picture.allUnits());
}

function Answer({ command, delivery }: { command: CommandView; delivery: DeliveryView }) {
  if (delivery.acknowledged_ms !== null) {
    return (
      <>
        {delivery.acknowledged_by}, {clockTime(delivery.acknowledged_ms)}
      </>
    );
  }
  if (delivery.state === "refused") return <>{delivery.reason}</>;
  if (!command.asks_wearer || !mayAct.value) return null;
  return (
    <button
      type="button"
      onClick={() => void attempt(api.confirmCommand(command.command_id, delivery.unit_id))}
    >
      Answered by voice
    </button>
  );
}
