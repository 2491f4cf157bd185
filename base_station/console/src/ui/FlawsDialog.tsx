import { picture } from "../sessions";
import { t } from "../language/translate";
import { Dialog } from "./Dialog";

/** Messages of its command in the terminal, for users of the console. */
export function FlawsDialog() {
  const flaws = picture.value?.replay.value?.flaws ?? [];
  return (
    <Dialog title={t("past.flaws")}>
      <ul class="problems">
        {flaws.map((flaw) => (
          <li key={flaw}>{flaw}</li>
        ))}
      </ul>
      <p class="quiet">{t("past.flaws_hint")}</p>
    </Dialog>
  );
}
