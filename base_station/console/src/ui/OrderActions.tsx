import { attempt, mayAct } from "../sessions";
import * as api from "../api";
import { stands, unanswered } from "../live/commands";
import type { CommandView } from "../wire";
import { clockTime } from "../format";
import { t } from "../language/translate";
import { ConfirmButton } from "./ConfirmButton";
import { useSinglePress } from "./useGuardedPress";

interface Props {
  command: CommandView;
  sent: (command: CommandView) => void; // that has followed from it
}

/** Actions on a sent order: send again, and end. */
export function OrderActions({ command, sent }: Props) {
  const once = useSinglePress();
  const { command_id: id } = command;
  const waited = unanswered(command);
  const repeated = Math.max(0, ...command.units.map((one) => one.repeated_ms ?? 0));
  const signals = command.kind === "locate" && command.open;
  if (!mayAct.value || (waited.length === 0 && !stands(command) && !signals)) return null;
  return (
    <div class="row order-actions">
      {waited.length > 0 && (
        <button type="button" onClick={() => once(() => attempt(api.repeatCommand(id)))}>
          {t("order.send_again_all", { count: waited.length })}
        </button>
      )}
      {stands(command) && (
        <ConfirmButton
          label={t("order.all_clear")}
          question={t("order.all_clear_question")}
          onConfirm={() => once(() => attempt(api.giveAllClear(id)).then((given) => given && sent(given)))}
        />
      )}
      {signals && (
        <button type="button" onClick={() => once(() => attempt(api.stopCommand(id)))}>
          {t("order.stop_locate")}
        </button>
      )}
      {repeated > 0 && <span>{t("order.sent_again", { time: clockTime(repeated) })}</span>}
    </div>
  );
}
