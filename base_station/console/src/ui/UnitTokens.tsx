import { useSignal } from "@preact/signals";
import { attempt, live } from "../sessions";
import * as api from "../api";
import { rich, t } from "../language/translate";
import { useSinglePress } from "./useGuardedPress";
import { fields } from "./useLoaded";

/** For an administrator: a token with which a unit posts its samples over HTTPS. */
export function UnitTokens() {
  const made = useSignal<{ unitId: string; token: string } | null>(null);
  const single = useSinglePress();
  const units = live.value?.picture.unitIds.value ?? [];
  const make = (unitId: string) => {
    single(() =>
      attempt(api.addUnitToken(unitId)).then((shown) => {
        made.value = shown === null ? null : { unitId, token: shown.token };
      }),
    );
  };
  return (
    <details>
      <summary>{t("units.post")}</summary>
      <form class="row" onSubmit={(event) => make(fields(event)["posting"] ?? "")}>
        <label>
          {t("units.posting")}
          <select name="posting" required>
            {units.map((unitId) => (
              <option key={unitId} value={unitId}>
                {unitId}
              </option>
            ))}
          </select>
        </label>
        <button>{t("units.make_token")}</button>
      </form>
      {made.value !== null && (
        <p role="status">
          {rich("units.token", {
            unit: <strong>{made.value.unitId}</strong>,
            token: <code>{made.value.token}</code>,
          })}
        </p>
      )}
    </details>
  );
}
