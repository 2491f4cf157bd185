import { attempt, mayAct } from "../sessions";
import * as api from "../api";
import { CANNOT_BE_NOTIFIED, commandWord, mayAnswerByRadio, progress, shownState, unanswered, unansweredFirst } from "../live/commands";
import { codedText } from "../live/codedText";
import type { Picture } from "../live/picture";
import { displayName, nameAmong } from "../live/urgency";
import { confirmAnswer } from "../undo";
import type { CommandView, DeliveryView } from "../wire";
import { clockTime } from "../format";
import { rich, t } from "../language/translate";
import { ByRadio } from "./ByRadio";
import { CommandState } from "./CommandState";
import { ConfirmButton } from "./ConfirmButton";
import { useGuardedPress, useSinglePress } from "./useGuardedPress";

interface Props {
  command: CommandView;
  picture: Picture;
}

/** Progress of an order: number of answers, and first the members without one. */
export function Deliveries({ command, picture }: Props) {
  return (
    <table class="deliveries stacked">
      <caption>
        {rich("order.caption", {
          order: commandWord(command),
          time: clockTime(command.issued_ms),
          who: command.issued_by,
          progress: <strong>{progress(command)}</strong>,
        })}
      </caption>
      <thead class="spoken">
        <tr>
          <th scope="col">{t("order.who")}</th>
          <th scope="col">{t("order.state")}</th>
          <th scope="col">{t("order.by_and_when")}</th>
        </tr>
      </thead>
      <tbody>
        {unansweredFirst(command).map((delivery, place) => (
          <tr key={delivery.unit_id}>
            <th scope="row">{nameOf(delivery.unit_id, picture)}</th>
            <td>
              <CommandState command={command} delivery={delivery} />
            </td>
            <td>
              <Answer command={command} delivery={delivery} place={place} picture={picture} />
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

interface AnswerProps extends Props {
  delivery: DeliveryView;
  place: number; // of the row: others answer, and move it
}

function Answer({ command, delivery, place, picture }: AnswerProps) {
  const steady = useGuardedPress(place);
  const { unit_id: unitId, reason } = delivery;
  const unit = picture.unit(unitId)?.value;
  const name = unit === undefined ? unitId : displayName(unit);
  if (delivery.acknowledged_ms !== null) {
    return <Acknowledged command={command} delivery={delivery} name={name} />;
  }
  const state = shownState(command, delivery);
  if (state === "ended") return null;
  if (reason !== "" && state !== CANNOT_BE_NOTIFIED) {
    return <>{codedText(delivery.reason_code ?? undefined, reason)}</>;
  }
  if (!mayAnswerByRadio(command, delivery) || !mayAct.value) return null;
  return (
    <span class="answered">
      <ByRadio
        label={t("order.answered_by_radio")}
        about={name}
        members={unit === undefined ? [] : [unit]}
        question={t("card.has_answered", { name })}
        onConfirm={steady(() => void confirmAnswer(command.command_id, unitId, name))}
      />
      <SendAgain command={command} delivery={delivery} name={name} />
    </span>
  );
}

/** Repeats the order to one member; answers of others move the row. */
function SendAgain({ command, delivery, name }: Named) {
  const once = useSinglePress();
  const { unit_id: unitId, repeated_ms: repeatedMs } = delivery;
  if (!unanswered(command).includes(delivery)) return null;
  const about = t("order.send_again_about", { order: commandWord(command), name });
  return (
    <button
      type="button"
      aria-label={t("common.about", { action: t("order.send_again"), what: about })}
      title={repeatedMs === null ? "" : t("order.sent_again", { time: clockTime(repeatedMs) })}
      onClick={() => once(() => attempt(api.repeatCommand(command.command_id, unitId)))}
    >
      {t("order.send_again")}
    </button>
  );
}

interface Named {
  command: CommandView;
  delivery: DeliveryView;
  name: string;
}

function Acknowledged({ command, delivery, name }: Named) {
  const { acknowledged_by: by, acknowledged_ms: atMs, acknowledged_via: via } = delivery;
  const radio = via === "radio";
  return (
    <span class="answered">
      {t(radio ? "order.by_radio" : "order.by_unit", { who: by, time: clockTime(atMs ?? 0) })}
      {radio && mayAct.value && (
        <ConfirmButton
          label={t("common.undo")}
          about={t("order.undo_about", { name })}
          question={t("order.undo_question", { name })}
          onConfirm={() =>
            void attempt(api.undoConfirmCommand(command.command_id, delivery.unit_id))
          }
        />
      )}
    </span>
  );
}
