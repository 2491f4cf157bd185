import { useSignal, type ReadonlySignal, type Signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import * as api from "../api";
import { timeSince } from "../format";
import { date } from "../language/measures";
import { codedTexts } from "../live/codedText";
import { displayName } from "../live/urgency";
import { attempt, picture, replay, steer } from "../sessions";
import type { Charts } from "../timeline/charts";
import {
  bounded,
  extremes,
  moved,
  STRIPS,
  valueAt,
  within,
  zoomed,
  type Span,
  type Strip,
  type Timeline,
} from "../timeline/series";
import { dialogUnit } from "../uiState";
import { t } from "../language/translate";
import { Dialog } from "./Dialog";

const WITHOUT_INCIDENT_MS = 3_600_000;
const BUCKETS = 1000; // one a pixel of the widest dialog

/** Measured and reported values of one unit over the incident; in a replay with the shown moment. */
export function TimelineDialog() {
  const unitId = dialogUnit.value;
  const unit = unitId === null ? undefined : picture.value?.unit(unitId)?.peek();
  if (unitId === null || unit === undefined) return null;
  return (
    <Dialog title={t("timeline.title", { name: displayName(unit) })} wide>
      <UnitTimeline unitId={unitId} />
    </Dialog>
  );
}

interface UnitTimelineProps {
  unitId: string;
  /** Of that span only. */
  only?: Span;
}

export function UnitTimeline({ unitId, only }: UnitTimelineProps) {
  const whole = useSignal(only ?? wholeSpan());
  const shown = useSignal(whole.peek());
  const timeline = useSignal<Timeline | null>(null);
  const asking = useSignal(true);
  const lookedAt = useSignal<number | null>(null);
  useEffect(() => {
    let isWanted = true;
    asking.value = true;
    const { fromMs, untilMs } = shown.value;
    void attempt(api.timeline(unitId, fromMs, untilMs, BUCKETS)).then((answer) => {
      if (!isWanted) return;
      asking.value = false;
      if (answer !== null) timeline.value = answer;
    });
    return () => {
      isWanted = false;
    };
  }, [unitId, shown.value]);
  const show = (span: Span) => {
    lookedAt.value = null;
    shown.value = span;
  };
  return (
    <div class="timeline" aria-busy={asking.value}>
      <Steps
        whole={whole.value}
        shown={shown.value}
        show={show}
        again={only === undefined ? () => show((whole.value = wholeSpan())) : null}
      />
      <p class="quiet">
        {spanWords(whole.value, shown.value)} {t("timeline.hint")}
        {isReplay() && ` ${t("timeline.hint_replay")}`}
        <span role="status">{asking.value && ` ${t("timeline.reading")}`}</span>
      </p>
      {codedTexts(timeline.value?.defects ?? [], timeline.value?.defect_codes).map((defect) => (
        <p key={defect} class="warned">
          {defect}
        </p>
      ))}
      {timeline.value && <Moment timeline={timeline.value} lookedAt={lookedAt} />}
      {timeline.value && (
        <Lines
          timeline={timeline.value}
          lookedAt={lookedAt}
          zoom={(span) => show(within(span, whole.value))}
        />
      )}
    </div>
  );
}

function spanWords(whole: Span, shown: Span): string {
  const [from, until] = [shown.fromMs, shown.untilMs].map((ms) => timeSince(whole.fromMs, ms));
  return t("timeline.span", { from: from ?? "", until: until ?? "", date: date(shown.fromMs) });
}

/** Of the replay, of the incident that runs, or the last hour. */
function wholeSpan(): Span {
  const of = picture.peek();
  const past = of?.replay.peek() ?? null;
  if (past !== null) return bounded({ fromMs: past.start_ms, untilMs: past.end_ms });
  const untilMs = of?.nowMs.peek() ?? 0;
  const incident = of?.incident.peek() ?? null;
  const runs = incident !== null && incident.closed_ms === null;
  return bounded({ fromMs: runs ? incident.opened_ms : untilMs - WITHOUT_INCIDENT_MS, untilMs });
}

function isReplay(): boolean {
  return replay.value !== null;
}

/** The moment of the replay; null: live. */
function shownMs(): number | null {
  return picture.value?.replay.value?.at_ms ?? null;
}

function seek(atMs: number): void {
  const watched = replay.peek();
  if (watched !== null) steer(watched, { at_ms: Math.round(atMs) });
}

interface StepsProps {
  whole: Span;
  shown: Span;
  show: (span: Span) => void;
  again: (() => void) | null; // null: the end is that of a span that is over
}

function Steps({ whole, shown, show, again }: StepsProps) {
  const isWhole = shown.fromMs === whole.fromMs && shown.untilMs === whole.untilMs;
  const step = (word: string, isDone: boolean, go: () => void) => (
    <button type="button" disabled={isDone} onClick={go}>
      {word}
    </button>
  );
  return (
    <div class="row" role="group" aria-label={t("timeline.time")}>
      {step(t("timeline.earlier"), shown.fromMs <= whole.fromMs, () => show(moved(shown, -1, whole)))}
      {step(t("timeline.later"), shown.untilMs >= whole.untilMs, () => show(moved(shown, 1, whole)))}
      {step(t("timeline.zoom_in"), false, () => show(zoomed(shown, 0.5, whole)))}
      {step(t("timeline.zoom_out"), isWhole, () => show(zoomed(shown, 2, whole)))}
      {step(t("timeline.all"), isWhole, () => show(whole))}
      {!isReplay() && again !== null && step(t("timeline.until_now"), false, again)}
    </div>
  );
}

interface LookProps {
  timeline: Timeline;
  lookedAt: Signal<number | null>;
}

/** The moment whose values are written beside the lines; by keys, too. */
function Moment({ timeline, lookedAt }: LookProps) {
  const { from_ms: fromMs, until_ms: untilMs } = timeline;
  const atMs = momentOf(timeline, lookedAt);
  return (
    <div class="row moment">
      <label class="long">
        {t("timeline.values_at", { time: timeSince(fromMs, atMs) })}
        <input
          type="range"
          min={fromMs}
          max={untilMs}
          step={1000}
          value={atMs}
          aria-valuetext={timeSince(fromMs, atMs)}
          onInput={(event) => (lookedAt.value = Number(event.currentTarget.value))}
        />
      </label>
      {isReplay() && (
        <button type="button" onClick={() => seek(atMs)}>
          {t("timeline.replay")}
        </button>
      )}
    </div>
  );
}

/** The moment under the pointer, else that of the replay, else the end. */
function momentOf({ from_ms, until_ms }: Timeline, lookedAt: ReadonlySignal<number | null>): number {
  const atMs = lookedAt.value ?? shownMs() ?? until_ms;
  return Math.min(Math.max(atMs, from_ms), until_ms);
}

interface LinesProps extends LookProps {
  zoom: (span: Span) => void;
}

function Lines({ timeline, lookedAt, zoom }: LinesProps) {
  const places = useRef<HTMLElement[]>([]);
  const charts = useSignal<Charts | null>(null);
  useEffect(() => {
    let isWanted = true;
    void attempt(import("../timeline/charts")).then((loaded) => {
      if (!isWanted || loaded === null) return;
      const look = (atMs: number | null) => (lookedAt.value = atMs);
      charts.value = new loaded.Charts(places.current, timeline, { look, seek, zoom });
    });
    return () => {
      isWanted = false;
      charts.peek()?.destroy();
      charts.value = null;
    };
  }, [timeline]);
  const [shown, looked] = [shownMs(), lookedAt.value];
  useEffect(() => charts.value?.mark({ shownMs: shown, lookedAtMs: looked }), [
    charts.value,
    shown,
    looked,
  ]);
  useEffect(() => {
    const resize = () => charts.peek()?.resize();
    addEventListener("resize", resize);
    return () => removeEventListener("resize", resize);
  }, []);
  return (
    <>
      {STRIPS.map((strip, number) => (
        <section key={strip.column} class="timeline-strip" aria-label={t(strip.title)}>
          <Reading strip={strip} timeline={timeline} atMs={momentOf(timeline, lookedAt)} />
          <div
            class="timeline-line"
            role="img"
            aria-label={t("timeline.strip", {
              title: t(strip.title),
              values: extremes(strip, timeline) ?? t("timeline.no_values"),
            })}
            ref={(place) => {
              if (place !== null) places.current[number] = place;
            }}
          />
        </section>
      ))}
    </>
  );
}

interface ReadingProps {
  strip: Strip;
  timeline: Timeline;
  atMs: number;
}

function Reading({ strip, timeline, atMs }: ReadingProps) {
  const value = valueAt(timeline[strip.column], atMs);
  const isEmpty = timeline[strip.column].t_ms.length === 0;
  return (
    <h3>
      {t(strip.title)}{" "}
      <output>{value === null ? t(isEmpty ? "timeline.no_values" : "timeline.unknown") : strip.text(value, timeline)}</output>
    </h3>
  );
}
