import { unanswered } from "../http";
import { t } from "../language/translate";

/** Placeholder of a list that is being loaded: an empty list would look as if there were no entries. */
export function Waiting() {
  return (
    <p class="quiet" role="status">
      {t("waiting.asking")}
    </p>
  );
}

/** Indication of a pending press, while the station has not answered over a slow link. */
export function Sending() {
  return (
    <span class="sending" role="status">
      {unanswered.value > 0 && t("waiting.sending")}
    </span>
  );
}
