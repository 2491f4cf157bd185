import { attempt, user } from "../sessions";
import * as api from "../api";
import { transferUrl } from "../live/loginTransfer";
import type { Picture } from "../live/picture";
import type { StandbyView } from "../wire";
import { ConfirmButton } from "./ConfirmButton";
import { Icon } from "./Icon";

/** At a station that does not lead: nobody may take it for the one that does. */
export function StandbyBar({ picture }: { picture: Picture }) {
  const reading = picture.health.value?.reading ?? null;
  if (reading !== null) return <ReadingBar share={reading} />;
  const standby = picture.health.value?.standby ?? null;
  if (standby === null || standby.role === "active") return null;
  return (
    <section class="standby-bar" aria-label="Standby">
      <Icon name="linkGood" />
      <strong>{standby.station} is the standby.</strong>
      <span>
        {standby.role === "waiting"
          ? "It waits for the other station and does not lead."
          : `${standby.other} leads. Here people can look; things are changed there.`}
        {!standby.in_step && " It has not caught up yet: what is shown may be old."}
      </span>
      <OtherConsole standby={standby} />
      {user.value !== null && user.value.role !== "viewer" && <TakeOver standby={standby} />}
    </section>
  );
}

/** After a crash without a saved state: nobody may take what was last stored for what is now. */
function ReadingBar({ share }: { share: number }) {
  return (
    <section class="standby-bar" aria-label="Reading the log">
      <Icon name="linkGood" />
      <strong>The station is reading its log: {Math.round(100 * share)} %.</strong>
      <span>
        This is what was last stored: nothing here is live, and nothing can be changed yet. Units go on
        by themselves, and what they say meanwhile is fetched.
      </span>
    </section>
  );
}

/** The way to the other station's console, where it has said it. */
export function OtherConsole({ standby }: { standby: StandbyView }) {
  if (!/^https?:/.test(standby.other_url)) return null;
  const way = transferUrl(standby.station, standby.other_url);
  return <a href={way}>Open the console of {standby.other}</a>;
}

function TakeOver({ standby }: { standby: StandbyView }) {
  return (
    <ConfirmButton
      label="Take over"
      question={`${standby.station} leads from now on.`}
      onConfirm={() => void attempt(api.takeOver())}
    />
  );
}
