import { t } from "../language/translate";
import { areImportsShown, imports, importsFailed } from "../plan/imports";

/** Switch for drawing imported files, with a sample of their line; nothing without imports. */
export function ImportsShown() {
  if (importsFailed.value) return <small>{t("imports.failed")}</small>;
  const count = imports.value.length;
  if (count === 0) return null;
  return (
    <label>
      <input
        type="checkbox"
        checked={areImportsShown.value}
        onChange={() => (areImportsShown.value = !areImportsShown.peek())}
      />
      <span class="trail-line imported" aria-hidden="true" />
      {t("imports.legend", { count: String(count) })}
    </label>
  );
}
