import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { clockTime, duration } from "../format";
import { resume } from "../sessions";
import { t } from "../language/translate";
import { Icon } from "./Icon";

const TRY_AGAIN_MS = 3_000;

/** Shown when the page was opened without its station: it reports that, and continues once the station
 * answers. */
export function StationAway() {
  const since = useSignal(Date.now());
  const now = useSignal(Date.now());
  useEffect(() => {
    const clock = setInterval(() => (now.value = Date.now()), 1000);
    const tries = setInterval(() => void resume(), TRY_AGAIN_MS);
    return () => [clock, tries].forEach(clearInterval);
  }, []);
  return (
    <main class="login">
      <div class="away">
        <h1>
          <Icon name="linkLost" /> {t("away.title")}
        </h1>
        <p role="alert">
          {t("away.hint", { host: location.host })}
        </p>
        <p>
          {t("away.tried", { time: clockTime(since.value), duration: duration(now.value - since.value) })}
        </p>
        <button type="button" class="primary" onClick={() => void resume()}>
          {t("away.again")}
        </button>
      </div>
    </main>
  );
}
