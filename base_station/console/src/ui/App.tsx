import { useEffect, useLayoutEffect } from "preact/hooks";
import { shownTheme, wall } from "../appearance";
import { begin, isPast, live, picture, replay, stationAway, user, waiting } from "../sessions";
import type { Picture } from "../live/picture";
import { sound } from "../sound";
import { entitle } from "../title";
import { dialog, pane } from "../uiState";
import { t } from "../language/translate";
import { AlarmStrip } from "./AlarmStrip";
import { Dialogs } from "./Dialogs";
import { DispatchBar } from "./DispatchBar";
import { PaneSwitch } from "./PaneSwitch";
import { Faults } from "./Faults";
import { ErrorBoundary } from "./ErrorBoundary";
import { Header } from "./Header";
import { LinkBanner } from "./LinkBanner";
import { Login } from "./Login";
import { Notice } from "./Notice";
import { People } from "./People";
import { PlanPanel } from "./PlanPanel";
import { RedLight } from "./RedLight";
import { ReplayBar } from "./ReplayBar";
import { StandbyBar } from "./StandbyBar";
import { StationAway } from "./StationAway";
import { UndoBar } from "./UndoBar";
import { useShortcuts } from "./shortcuts";
import { Sending } from "./Waiting";
import { Wall } from "./Wall";

export function App() {
  useAttention();
  useWaiting();
  useShortcuts();
  if (stationAway.value) return <StationAway />;
  const shown = picture.value;
  const login = user.value === null || waiting.value;
  return (
    <>
      {shownTheme.value === "red" && <RedLight />}
      {user.value !== null && shown !== null && <Console shown={shown} />}
      {login && <Login enter={begin} />}
    </>
  );
}

/** Unseen behind the login form once the login has ended, with all that was being written. */
function Console({ shown }: { shown: Picture }) {
  const kind = isPast.value ? "replay" : "live";
  const link = shown.link.value.kind;
  const stored = (shown.health.value?.reading ?? null) !== null;
  const unrecorded = (shown.replay.value?.gap ?? null) !== null;
  const notNow =
    stored || unrecorded || link === "down" || (link === "connecting" && shown.ready.value);
  return (
    <div
      class={`console ${kind} ${link === "down" ? "stopped" : ""} ${notNow ? "not-now" : ""}`}
      hidden={waiting.value}
    >
      <ErrorBoundary what={t("frame.link_state")}>
        <LinkBanner picture={shown} />
      </ErrorBoundary>
      <ErrorBoundary what={t("frame.stations_state")}>
        <StandbyBar picture={shown} />
      </ErrorBoundary>
      <ErrorBoundary what={t("frame.dispatch_offer")}>
        <DispatchBar picture={shown} />
      </ErrorBoundary>
      {replay.value && live.value && (
        <ErrorBoundary what={t("frame.replay")}>
          <ReplayBar replay={replay.value} live={live.value.picture} />
        </ErrorBoundary>
      )}
      {wall.value === "on" ? (
        <ErrorBoundary what={t("frame.wall")}>
          <Wall picture={shown} />
        </ErrorBoundary>
      ) : (
        <Desk shown={shown} kind={kind} />
      )}
      {dialog.value === null && <Sending />}
      {dialog.value === null && <Notice />}
      {dialog.value === null && <UndoBar />}
      <Dialogs />
    </div>
  );
}

/** The part between the banners and the notice. */
function Desk({ shown, kind }: { shown: Picture; kind: "live" | "replay" }) {
  return (
    <>
      <ErrorBoundary what={t("frame.header")}>
        <Header picture={shown} />
      </ErrorBoundary>
      <Faults />
      <ErrorBoundary what={t("frame.alarms")}>
        <AlarmStrip picture={shown} />
      </ErrorBoundary>
      <main class="main">
        <PaneSwitch />
        <div class={`columns with-${pane.value}`}>
          <ErrorBoundary what={t("frame.people")} key={kind}>
            <People picture={shown} />
          </ErrorBoundary>
          <ErrorBoundary what={t("frame.plan")}>
            <PlanPanel picture={shown} />
          </ErrorBoundary>
        </div>
      </main>
      <footer class="footer">
        {t("frame.pass_device")} <span>{t("frame.temperatures")}</span>
      </footer>
    </>
  );
}

/** Signals for a user who looks elsewhere: sounds, and the page's title. */
function useAttention(): void {
  const watched = waiting.value ? undefined : live.value?.picture;
  useEffect(() => {
    if (watched === undefined) return undefined;
    const ends = [sound(watched), entitle(watched)];
    return () => ends.forEach((end) => end());
  }, [watched]);
}

/** Nothing covers the login form; a user who returns continues where the login ended. */
function useWaiting(): void {
  useLayoutEffect(() => {
    if (!waiting.value) return undefined;
    const held = document.activeElement; // the login form takes it later
    const dialogs = [...document.querySelectorAll<HTMLDialogElement>("dialog[open]")];
    dialogs.forEach((one) => one.close());
    return () => {
      dialogs.filter((one) => one.isConnected).forEach((one) => one.showModal());
      if (held instanceof HTMLElement) held.focus();
    };
  }, [waiting.value]);
}
