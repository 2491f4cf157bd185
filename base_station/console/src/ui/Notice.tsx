import { notice } from "../uiState";
import { t } from "../language/translate";

/** The last notice; a dialog shows it inside, as nothing behind a dialog can be read or pressed. */
export function Notice() {
  if (notice.value === null) return null;
  return (
    <div class="notice" role="alert">
      <span>{notice.value}</span>
      <button type="button" onClick={() => (notice.value = null)}>
        {t("menu.ok")}
      </button>
    </div>
  );
}
