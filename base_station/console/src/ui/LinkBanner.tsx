import type { JSX } from "preact";
import { useEffect } from "preact/hooks";
import { useSignal } from "@preact/signals";
import type { Picture } from "../live/picture";
import { live } from "../sessions";
import { clockTime, duration } from "../format";
import { rich, t } from "../language/translate";
import { Icon } from "./Icon";
import { OtherConsole } from "./StandbyBar";

/** When the station is not received, nothing on the screen may look current. */
export function LinkBanner({ picture }: { picture: Picture }) {
  const lost = useLost(picture);
  if (lost === null) return null;
  const standby = picture.health.peek()?.standby;
  const shown = picture.ready.value
    ? t("connection.picture_from", { time: clockTime(picture.heardMs.peek()) })
    : "";
  return (
    <div class="link-banner" role="alert">
      {lost}
      <span>
        {shown} {t("connection.trying")}
      </span>
      {standby && <OtherConsole standby={standby} />}
    </div>
  );
}

/** The same in a dialog, which covers the banner. */
export function LinkLost() {
  const watched = live.value?.picture;
  return watched === undefined ? null : <LostInDialog picture={watched} />;
}

function LostInDialog({ picture }: { picture: Picture }) {
  const lost = useLost(picture);
  return (
    <div role="alert" class={lost === null ? "" : "link-banner"}>
      {lost}
      {lost !== null && <span>{t("connection.nothing_updated")}</span>}
    </div>
  );
}

/** Text of a lost link with its time; null while the link is up. */
function useLost(picture: Picture): JSX.Element | null {
  const link = picture.link.value;
  const age = useSignal("");
  const sinceMs = link.kind === "down" ? link.sinceMs : null;
  useEffect(() => {
    if (sinceMs === null) return undefined;
    const tell = () => (age.value = duration(performance.now() - sinceMs));
    tell();
    const timer = setInterval(tell, 500);
    return () => clearInterval(timer);
  }, [sinceMs]);
  if (sinceMs === null) return null;
  return (
    <>
      <Icon name="linkLost" />
      <strong>
        {rich("connection.lost_since", {
          age: <span aria-live="off">{t("measure.ago", { age: age.value })}</span>,
        })}
      </strong>
    </>
  );
}
