import { useEffect } from "preact/hooks";
import { isPast, live, picture, replay, user } from "../sessions";
import { sound } from "../sound";
import { entitle } from "../title";
import { dialog, half } from "../view";
import { AlarmStrip } from "./AlarmStrip";
import { Dialogs } from "./Dialogs";
import { Halves } from "./Halves";
import { Header } from "./Header";
import { LinkBanner } from "./LinkBanner";
import { Login } from "./Login";
import { Notice } from "./Notice";
import { People } from "./People";
import { PlanPanel } from "./PlanPanel";
import { ReplayBar } from "./ReplayBar";
import { StandbyBar } from "./StandbyBar";
import { Sending } from "./Waiting";

export function App() {
  useAttention();
  if (user.value === null) return <Login />;
  const shown = picture.value;
  if (shown === null) return null;
  const kind = isPast.value ? "replay" : "live";
  const stopped = shown.link.value.kind === "down";
  const stored = (shown.health.value?.reading ?? null) !== null;
  return (
    <div class={`console ${kind} ${stopped ? "stopped" : ""} ${stopped || stored ? "not-now" : ""}`}>
      <LinkBanner picture={shown} />
      <StandbyBar picture={shown} />
      {replay.value && live.value && <ReplayBar replay={replay.value} live={live.value.picture} />}
      <Header picture={shown} />
      <AlarmStrip picture={shown} />
      <main class="main">
        <Halves />
        <div class={`columns with-${half.value}`}>
          <People picture={shown} key={kind} />
          <PlanPanel picture={shown} />
        </div>
      </main>
      <footer class="footer">
        Muster supplements a certified PASS device and never replaces it.{" "}
        <span>Temperatures are of the equipment’s environment, not of the wearer.</span>
      </footer>
      {dialog.value === null && <Sending />}
      {dialog.value === null && <Notice />}
      <Dialogs />
    </div>
  );
}

/** What reaches who is looking elsewhere: sounds, and the page's title. */
function useAttention(): void {
  const watched = live.value?.picture;
  useEffect(() => {
    if (watched === undefined) return undefined;
    const ends = [sound(watched), entitle(watched)];
    return () => ends.forEach((end) => end());
  }, [watched]);
}
