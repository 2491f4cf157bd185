import { unanswered } from "../http";
import { t } from "../language/translate";

/** In the place of a list that the station has not given yet: an empty one would look as if there were
 * nothing. */
export function Waiting() {
  return (
    <p class="quiet" role="status">
      {t("waiting.asking")}
    </p>
  );
}

/** That a press was noticed, while the station has not answered it over a slow link. */
export function Sending() {
  return (
    <span class="sending" role="status">
      {unanswered.value > 0 && t("waiting.sending")}
    </span>
  );
}
