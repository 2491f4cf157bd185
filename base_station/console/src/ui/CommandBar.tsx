import { mayAct } from "../sessions";
import { openDialog } from "../uiState";
import { commandWord, current, newestFirst, progress, stands } from "../live/commands";
import type { Picture } from "../live/picture";
import { t } from "../language/translate";

/** Orders to everyone with two presses, and their progress. */
export function CommandBar({ picture }: { picture: Picture }) {
  const commands = current(picture.commands.value.values(), picture.incident.value);
  const open = newestFirst(commands).filter((command) => command.open || stands(command));
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
        {open.map((command) => (
          <li key={command.command_id}>
            <strong>{commandWord(command)}</strong> {progress(command)}
          </li>
        ))}
      </ul>
    </div>
  );
}
