import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { clockTime, duration } from "../format";
import { resume } from "../sessions";
import { Icon } from "./Icon";

const TRY_AGAIN_MS = 3_000;

/** The page was opened without its station: it knows nothing, says so, and goes on once the station answers. */
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
          <Icon name="linkLost" /> Station away
        </h1>
        <p role="alert">
          The base station does not answer at {location.host}. Nothing is shown, because nothing that this page knows
          is current. Use the voice radio.
        </p>
        <p>
          Tried since {clockTime(since.value)}, for {duration(now.value - since.value)}. The console comes by itself
          once the station answers.
        </p>
        <button type="button" class="primary" onClick={() => void resume()}>
          Try again now
        </button>
      </div>
    </main>
  );
}
