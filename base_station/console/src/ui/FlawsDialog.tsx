import { picture } from "../sessions";
import { codedTexts } from "../live/codedText";
import { t } from "../language/translate";
import { Dialog } from "./Dialog";

/** Messages of its command in the terminal, for users of the console. */
export function FlawsDialog() {
  const replay = picture.value?.replay.value;
  const flaws = codedTexts(replay?.flaws ?? [], replay?.flaw_codes);
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
