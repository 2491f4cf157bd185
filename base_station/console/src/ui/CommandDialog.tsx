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
  const about = dialogUnit.value;
  const once = useOnce();
  const units = picture.unitIds.value
    .map((unitId) => picture.unit(unitId)?.value)
    .filter((unit) => unit !== undefined)
    .filter((unit) => unit.registered);
  return (
    <form
      class="row command-form"
      onSubmit={(event) => {
        const form = event.currentTarget;
        const { target = "everyone", text = "" } = fields(event);
        once(() =>
          attempt(api.sendCommand(kind, targetOf(target), text)).then(
            (command) => command && clearText(form),
          ),
        );
      }}
    >
      <p>{SAYS[kind]}</p>
      <label>
        To
        <select name="target" defaultValue={about === null ? "everyone" : `unit:${about}`}>
          <option value="everyone">Everyone</option>
          {crewsOf(units).map((crew) => (
            <option key={crew} value={`crew:${crew}`}>
              {crew}
            </option>
          ))}
          {units.map((unit) => (
            <option key={unit.unit_id} value={`unit:${unit.unit_id}`}>
              {nameAmong(unit, units)}
            </option>
          ))}
        </select>
      </label>
      {kind === "text" && (
        <label class="long">
          Message
          <input name="text" required maxLength={120} />
        </label>
      )}
      <button class={kind === "evacuate" ? "danger" : "primary"}>
        {kind === "evacuate" ? "Evacuate now" : "Send"}
      </button>
    </form>
  );
}

/** What is sent next is for the same people: reset as a whole, the form would be for everyone. */
function clearText(form: HTMLFormElement): void {
  const text = form.elements.namedItem("text");
  if (text instanceof HTMLInputElement) text.value = "";
}

function targetOf(value: string): Target {
  const name = value.slice(value.indexOf(":") + 1);
  if (value.startsWith("crew:")) return { crew: name };
  return value.startsWith("unit:") ? { unit_id: name } : { everyone: true };
}

function Deliveries({ command, picture }: { command: CommandView; picture: Picture }) {
  return (
    <table class="deliveries">
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
