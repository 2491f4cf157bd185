import { ImportsShown } from "./ImportsShown";
import { KINDS, loadingKinds, shownKinds, toggle } from "../plan/pastTrails";
import { selectedUnit } from "../uiState";
import { t } from "../language/translate";
import { PanelActions } from "./PanelActions";

/** Which trails are drawn, with the lines they are drawn in. */
export function TrailsPanel() {
  const ofChosen = selectedUnit.value === null ? "" : "of-chosen";
  return (
    <section class="tool-panel trails" aria-label={t("trail.title")}>
      <h3>{t("trail.title")}</h3>
      {KINDS.map((kind) => (
        <label key={kind}>
          <input
            type="checkbox"
            checked={shownKinds.value.has(kind)}
            onChange={() => toggle(kind)}
          />
          <span class={`trail-line ${kind} ${ofChosen}`} aria-hidden="true" />
          {t(`trail.${kind}`)}
          {loadingKinds.value.has(kind) && <small> {t("trail.loading")}</small>}
        </label>
      ))}
      <ImportsShown />
      <p class="quiet">
        {t(selectedUnit.value === null ? "trail.hint_all" : "trail.hint_chosen")}
      </p>
      <PanelActions />
    </section>
  );
}
