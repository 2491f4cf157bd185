import { t } from "../language/translate";
import { VIEWS, view } from "../section/shown";

/** Chooses how the building's height is shown. */
export function SectionView() {
  return (
    <label>
      <span>{t("section.view")}</span>
      <select
        aria-label={t("section.view")}
        value={view.value}
        onChange={(event) => (view.value = event.currentTarget.value as (typeof VIEWS)[number])}
      >
        {VIEWS.map((one) => (
          <option key={one} value={one}>
            {t(`section.view_${one}`)}
          </option>
        ))}
      </select>
    </label>
  );
}
