import { attempt, user } from "../sessions";
import * as api from "../api";
import { transferUrl } from "../live/loginTransfer";
import type { Picture } from "../live/picture";
import type { StandbyView } from "../wire";
import { share as percent } from "../language/measures";
import { t } from "../language/translate";
import { ConfirmButton } from "./ConfirmButton";
import { Icon } from "./Icon";

/** Bar at a standby: it must not be taken for the leading station. */
export function StandbyBar({ picture }: { picture: Picture }) {
  const reading = picture.health.value?.reading ?? null;
  if (reading !== null) return <ReadingBar share={reading} />;
  const standby = picture.health.value?.standby ?? null;
  if (standby === null || standby.role === "active") return null;
  return (
    <section class="standby-bar" aria-label={t("standby.title")}>
      <Icon name="linkGood" />
      <strong>{t("standby.is_standby", { station: standby.station })}</strong>
      <span>
        {standby.role === "waiting"
          ? t("standby.waits")
          : t("standby.other_leads", { other: standby.other })}
        {!standby.in_step && ` ${t("standby.behind")}`}
      </span>
      <OtherConsole standby={standby} />
      {user.value !== null && user.value.role !== "viewer" && <TakeOver standby={standby} />}
    </section>
  );
}

/** Bar after a crash without a saved state: the last stored state must not be taken for the present. */
function ReadingBar({ share }: { share: number }) {
  return (
    <section class="standby-bar" aria-label={t("standby.reading")}>
      <Icon name="linkGood" />
      <strong>{t("standby.reading_share", { share: percent(share) })}</strong>
      <span>{t("standby.reading_hint")}</span>
    </section>
  );
}

/** Link to the other station's console, where its address is known. */
export function OtherConsole({ standby }: { standby: StandbyView }) {
  if (!/^https?:/.test(standby.other_url)) return null;
  const way = transferUrl(standby.station, standby.other_url);
  return <a href={way}>{t("standby.open_other", { other: standby.other })}</a>;
}

function TakeOver({ standby }: { standby: StandbyView }) {
  return (
    <ConfirmButton
      label={t("standby.take_over")}
      question={t("standby.take_over_question", { station: standby.station })}
      onConfirm={() => void attempt(api.takeOver())}
    />
  );
}
