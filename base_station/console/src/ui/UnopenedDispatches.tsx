import { live } from "../sessions";
import { summary } from "../live/dispatch";
import { t } from "../language/translate";
import { openDispatch } from "../uiState";

/** Dispatches from which no incident was opened: offered, dismissed, or over. */
export function UnopenedDispatches() {
  const dispatches = live.value?.picture.dispatches.value ?? [];
  if (dispatches.length === 0) return null;
  return (
    <section aria-label={t("incident.dispatches")}>
      <h3>{t("incident.from_dispatch")}</h3>
      <ul class="dispatches">
        {dispatches.toReversed().map((one) => (
          <li class="row" key={one.number}>
            <span>
              <strong>{one.number}</strong> {summary(one)}
              {one.has_ended && <span class="quiet"> {t("incident.ended")}</span>}
              {one.is_dismissed && <span class="quiet"> {t("incident.dismissed")}</span>}
            </span>
            <button
              type="button"
              aria-label={t("incident.look_at", { number: one.number })}
              onClick={() => openDispatch(one.number)}
            >
              {t("incident.look")}
            </button>
          </li>
        ))}
      </ul>
    </section>
  );
}
