import { mayAct } from "../sessions";
import { undoable, undoNow } from "../undo";
import { t } from "../language/translate";

/** What was just entered by radio, with the press that undoes it; in a dialog it stands in it. */
export function UndoBar() {
  const one = undoable.value;
  return (
    <div class={one === null || !mayAct.value ? "no-undo" : "notice undo"} role="status">
      {one !== null && mayAct.value && (
        <>
          <span>{one.words}</span>
          <button type="button" onClick={() => undoNow(one)}>
            {t("par.undo")}
          </button>
        </>
      )}
    </div>
  );
}
