import { isPast, live, picture, replay, user } from "../sessions";
import { notice } from "../view";
import { AlarmStrip } from "./AlarmStrip";
import { Dialogs } from "./Dialogs";
import { Header } from "./Header";
import { LinkBanner } from "./LinkBanner";
import { Login } from "./Login";
import { People } from "./People";
import { PlanPanel } from "./PlanPanel";
import { ReplayBar } from "./ReplayBar";
import { StandbyBar } from "./StandbyBar";

export function App() {
  if (user.value === null) return <Login />;
  const shown = picture.value;
  if (shown === null) return null;
  const kind = isPast.value ? "replay" : "live";
  const stopped = shown.link.value.kind === "down";
  return (
    <div class={`console ${kind} ${stopped ? "stopped" : ""}`}>
      <LinkBanner picture={shown} />
      <StandbyBar picture={shown} />
      {replay.value && live.value && <ReplayBar replay={replay.value} live={live.value.picture} />}
      <Header picture={shown} />
      <AlarmStrip picture={shown} />
      <main class="columns">
        <People picture={shown} key={kind} />
        <PlanPanel picture={shown} />
      </main>
      <footer class="footer">
        Muster supplements a certified PASS device and never replaces it. Temperatures are of the
        equipment’s environment, not of the wearer.
      </footer>
      <Notice />
      <Dialogs />
    </div>
  );
}

function Notice() {
  if (notice.value === null) return null;
  return (
    <div class="notice" role="alert">
      <span>{notice.value}</span>
      <button type="button" onClick={() => (notice.value = null)}>
        Close
      </button>
    </div>
  );
}
