import { faults } from "../live/faults";
import { t } from "../language/translate";
import { Icon } from "./Icon";

/** What could not be shown, until a person has read it. */
export function Faults() {
  if (faults.value.length === 0) return null;
  return (
    <div class="faults" role="alert">
      <Icon name="alarm" />
      <ul>
        {faults.value.map((sentence) => (
          <li key={sentence}>{sentence}</li>
        ))}
      </ul>
      <button type="button" onClick={() => (faults.value = [])}>
        {t("common.ok")}
      </button>
    </div>
  );
}
