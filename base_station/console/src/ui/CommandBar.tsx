import { mayAct } from "../sessions";
import { openDialog } from "../uiState";
import { commandWord, current, progress, underWay } from "../live/commands";
import type { Picture } from "../live/picture";
import { t } from "../language/translate";

const ROWS = 2; // beside the buttons: more would move what stands below

/** Orders to everyone with two presses, and their progress. */
export function CommandBar({ picture }: { picture: Picture }) {
  const commands = current(picture.commands.value.values(), picture.incident.value);
  const open = underWay(commands);
  const shown = open.length <= ROWS ? open : open.slice(0, ROWS - 1);
  const more = open.length - shown.length;
  if (!mayAct.value && open.length === 0) return null;
  return (
    <div class="command-bar" role="group" aria-label={t("order.commands")}>
      {mayAct.value && (
        <>
          <button type="button" class="danger" aria-keyshortcuts="E" onClick={() => openDialog("evacuate")}>
            {t("order.evacuate")}
          </button>
          <button type="button" aria-keyshortcuts="P" onClick={() => openDialog("par_request")}>
            {t("order.par_request")}
          </button>
          <button type="button" onClick={() => openDialog("text")}>
            {t("order.text")}
          </button>
        </>
      )}
      <ul aria-label={t("order.open")}>
        {shown.map((command) => (
          <li key={command.command_id}>
            <strong>{commandWord(command)}</strong> {progress(command)}
          </li>
        ))}
        {more > 0 && (
          <li>
            <button type="button" class="more-orders" onClick={() => openDialog("text")}>
              {t("order.more", { count: more })}
            </button>
          </li>
        )}
      </ul>
    </div>
  );
}
