import { besideLive, liveIsPast, stopReplay, type Replay } from "../sessions";
import { assess, openDialog } from "../uiState";
import type { Picture } from "../live/picture";
import { dateAndTime, timeSince, zone } from "../format";
import { codedTexts, problemsOf } from "../live/codedText";
import type { GapView } from "../wire";
import { t } from "../language/translate";
import { Icon } from "./Icon";
import { RadioPlayer } from "./RadioPlayer";
import { Transport } from "./Transport";

interface Props {
  replay: Replay;
  live: Picture;
}

/** Marks of a replay, so that the past is not taken for the present: a banner, a frame, and live alarms. */
export function ReplayBar({ replay, live }: Props) {
  const state = replay.session.picture.replay.value;
  return (
    <section class="replay-bar" aria-label={t("replay.title")}>
      <strong class="replay-word">{t("replay.word")}</strong>
      <span class="replay-what">
        {t("replay.what", {
          incident: replay.incident.name,
          time: dateAndTime(replay.incident.opened_ms),
          zone: zone(replay.incident.opened_ms),
        })}
      </span>
      {state && <Flaws flaws={codedTexts(state.flaws, state.flaw_codes)} />}
      {state?.gap && <Gap gap={state.gap} startMs={state.start_ms} />}
      <button
        type="button"
        class="about-positions"
        onClick={() => assess(replay.incident)}
      >
        {t("replay.accuracy")}
      </button>
      {besideLive.value && liveIsPast.value && (
        <button type="button" class="primary" onClick={stopReplay}>
          {t("replay.first")}
        </button>
      )}
      {besideLive.value && !liveIsPast.value && (
        <>
          <LiveAlarms live={live} />
          <button type="button" class="primary" onClick={stopReplay}>
            {t("replay.live")}
          </button>
          <LiveProblems live={live} />
        </>
      )}
      {state && <Transport key={replay.id} replay={replay} state={state} />}
      {state && <RadioPlayer key={`radio ${replay.id}`} replay={replay} state={state} />}
    </section>
  );
}

/** Differences between a replay and what the commander saw: a partial log, or another version. */
function Flaws({ flaws }: { flaws: readonly string[] }) {
  if (flaws.length === 0) return null;
  return (
    <button type="button" class="flaws" title={flaws.join("\n")} onClick={() => openDialog("flaws")}>
      <Icon name="alarm" /> {t("replay.flaws", { count: flaws.length })}
    </button>
  );
}

/** In a gap the last recorded state before it is shown. */
function Gap({ gap, startMs }: { gap: GapView; startMs: number }) {
  return (
    <span class="replay-live alarmed" role="alert">
      <Icon name="linkLost" />{" "}
      {t("replay.gap", { from: timeSince(startMs, gap.from_ms), until: timeSince(startMs, gap.until_ms) })}
      <span class="gap-shown">{t("replay.gap_shown")}</span>
    </span>
  );
}

function LiveAlarms({ live }: { live: Picture }) {
  const open = live.openAlarms.value.length;
  if (open === 0) return <span class="replay-live">{t("replay.no_alarms")}</span>;
  return (
    <span class="replay-live alarmed" role="alert">
      <Icon name="alarm" /> {t("replay.alarms", { count: open })}
    </span>
  );
}

/** The station's own: the picture of the past does not have them. */
function LiveProblems({ live }: { live: Picture }) {
  const health = live.health.value;
  const [first, ...more] = health === null ? [] : problemsOf(health);
  if (first === undefined) return null;
  return (
    <span class="replay-live alarmed" role="alert">
      <Icon name="alarm" /> {t("replay.station", { problem: first })}
      {more.length > 0 && ` +${more.length}`}
    </span>
  );
}
