import { useSignal } from "@preact/signals";
import type { RehearsalAnswer, ThresholdAnswer } from "../answers";
import * as api from "../api";
import { ruleWord } from "../format";
import { listed, number } from "../language/measures";
import { codedTexts } from "../live/codedText";
import {
  CHART_HEIGHT,
  CHART_WIDTH,
  chartLine,
  COUNTS,
  levelLabel,
  person,
  pointLabel,
  possible,
  raisedAt,
  rate,
  shift,
  STEP,
  SWEPT,
  text,
  thresholdLabel,
  UNTIL,
  wantedOf,
  type Fields,
} from "../rehearsal";
import { attempt } from "../sessions";
import { Columns } from "./Columns";
import { fields, useLoaded } from "./useLoaded";

/** The thresholds to rehearse over an incident, and the outcome. */
export function Rehearsal({ incidentId }: { incidentId: string }) {
  const [thresholds] = useLoaded(() => api.thresholds(incidentId));
  const outcome = useSignal<RehearsalAnswer | "running" | "failed" | "unchanged" | null>(null);
  const start = (rule: readonly ThresholdAnswer[], given: Fields) => {
    const wanted = wantedOf(rule, given);
    if (wanted === null) {
      outcome.value = "unchanged";
      return;
    }
    if (outcome.peek() === "running") return;
    outcome.value = "running";
    void attempt(api.rehearsal(incidentId, wanted.changes, wanted.sweep)).then((answer) => {
      outcome.value = answer ?? "failed";
    });
  };
  return (
    <>
      <p class="quiet">{text("what")}</p>
      {thresholds.value !== null && (
        <ThresholdForm all={thresholds.value} isRunning={outcome.value === "running"} start={start} />
      )}
      <div aria-live="polite" aria-busy={outcome.value === "running"}>
        <Outcome outcome={outcome.value} />
      </div>
    </>
  );
}

interface FormProps {
  all: readonly ThresholdAnswer[];
  isRunning: boolean;
  start: (rule: readonly ThresholdAnswer[], given: Fields) => void;
}

function ThresholdForm({ all, isRunning, start }: FormProps) {
  const rules = [...new Set(all.map((one) => one.rule))];
  const chosen = useSignal(rules[0] ?? "");
  const swept = useSignal("");
  const thresholds = all.filter((one) => one.rule === chosen.value);
  return (
    <form class="rehearsal" onSubmit={(event) => start(thresholds, fields(event))}>
      <label>
        {text("alarm_kind")}
        <select
          value={chosen.value}
          onChange={(event) => {
            swept.value = "";
            chosen.value = event.currentTarget.value;
          }}
        >
          {rules.map((rule) => (
            <option key={rule} value={rule}>
              {ruleWord(rule)}
            </option>
          ))}
        </select>
      </label>
      <fieldset key={chosen.value}>
        <legend>{text("values")}</legend>
        <div class="row">
          {thresholds.map((one) => (
            <Value key={one.threshold} of={one} name={one.threshold} label={thresholdLabel(one.threshold)} />
          ))}
        </div>
        <div class="row">
          <label>
            {text("sweep")}
            <select name={SWEPT} value={swept.value} onChange={(event) => (swept.value = event.currentTarget.value)}>
              <option value="">{text("no_sweep")}</option>
              {thresholds.map((one) => (
                <option key={one.threshold} value={one.threshold}>
                  {thresholdLabel(one.threshold)}
                </option>
              ))}
            </select>
          </label>
          {thresholds
            .filter((one) => one.threshold === swept.value)
            .map((one) => (
              <Range key={one.threshold} of={one} />
            ))}
        </div>
      </fieldset>
      <button class="primary" disabled={isRunning}>
        {text("start")}
      </button>
    </form>
  );
}

interface ValueProps {
  of: ThresholdAnswer;
  name: string;
  label: string;
  value?: number;
}

function Value({ of, name, label, value = of.value }: ValueProps) {
  return (
    <label>
      {label}
      <input name={name} type="number" step="any" required min={of.lowest} max={of.highest} defaultValue={String(value)} />
    </label>
  );
}

/** The end and the step of several values; the first is that of the threshold's own field. */
function Range({ of }: { of: ThresholdAnswer }) {
  const step = Math.max((of.highest - of.value) / 10, Number.EPSILON);
  const rounded = Number(step.toPrecision(1));
  return (
    <>
      <Value of={of} name={UNTIL} label={text("until")} value={of.highest} />
      <label>
        {text("step")}
        <input name={STEP} type="number" step="any" required min={Number.EPSILON} defaultValue={String(rounded)} />
      </label>
    </>
  );
}

function Outcome({ outcome }: { outcome: RehearsalAnswer | "running" | "failed" | "unchanged" | null }) {
  if (outcome === null) return null;
  if (outcome === "running") return <p>{text("running")}</p>;
  if (outcome === "failed") return <p class="warned">{text("failed")}</p>;
  if (outcome === "unchanged") return <p class="warned">{text("unchanged")}</p>;
  const points = possible(outcome);
  const impossible = outcome.points.filter(({ problem }) => problem !== "");
  const count = Object.values(outcome.live_alarms).reduce((sum, one) => sum + one, 0);
  return (
    <>
      {codedTexts(outcome.flaws, outcome.flaw_codes).map((flaw) => (
        <p key={flaw} class="warned">
          {flaw}
        </p>
      ))}
      {points.length > 0 && <p>{text("worn", { hours: number(outcome.worn_h, 2), count })}</p>}
      {impossible.length > 0 && (
        <p class="warned">{text("impossible", { values: listed(impossible.map((one) => pointLabel(outcome, one.thresholds))) })}</p>
      )}
      {points[0]?.levels.map((_, row) => <Level key={row} outcome={outcome} row={row} />)}
      {outcome.swept === "" && points[0] !== undefined && <Changes outcome={outcome} />}
    </>
  );
}

/** Figures of one level of the rule: as it was, and by each set of thresholds. */
function Level({ outcome, row }: { outcome: RehearsalAnswer; row: number }) {
  const points = possible(outcome);
  const levels = points.flatMap((point) => point.levels[row] ?? []);
  const first = levels[0];
  if (first === undefined) return null;
  return (
    <table class="stacked">
      <caption>{levelLabel(first)}</caption>
      <Columns
        names={[text("value"), text("raised"), text("per_hour"), ...COUNTS.map((one) => text(one)), text("shift")]}
      />
      <tbody>
        <tr>
          <th scope="row">{text("then")}</th>
          <td data-label={text("raised")}>{first.recorded}</td>
          <td data-label={text("per_hour")}>{rate(first.recorded_per_hour)}</td>
          <td colSpan={COUNTS.length + 1} />
        </tr>
        {levels.map((one, place) => (
          <tr key={place}>
            <th scope="row">{pointLabel(outcome, points[place]?.thresholds ?? {})}</th>
            <td data-label={text("raised")}>{one.rehearsed}</td>
            <td data-label={text("per_hour")}>{rate(one.rehearsed_per_hour)}</td>
            {COUNTS.map((count) => (
              <td key={count} data-label={text(count)}>
                {one[count]}
              </td>
            ))}
            <td data-label={text("shift")}>{shift(one.median_shift_s)}</td>
          </tr>
        ))}
      </tbody>
      {outcome.swept !== "" && (
        <tfoot>
          <tr>
            <td colSpan={COUNTS.length + 4}>
              <Chart outcome={outcome} row={row} />
            </td>
          </tr>
        </tfoot>
      )}
    </table>
  );
}

function Chart({ outcome, row }: { outcome: RehearsalAnswer; row: number }) {
  const levels = possible(outcome).flatMap((point) => point.levels[row] ?? []);
  const line = chartLine(levels);
  if (line === null) return null;
  const threshold = thresholdLabel(outcome.swept.split(".")[1] ?? "");
  const values = levels.map((one) => rate(one.rehearsed_per_hour)).join(", ");
  const then = rate(levels[0]?.recorded_per_hour ?? null);
  const title = text("chart", { threshold, values, then });
  return (
    <figure class="trade-off">
      <svg
        viewBox={`-1 -1 ${CHART_WIDTH + 2} ${CHART_HEIGHT + 2}`}
        preserveAspectRatio="none"
        role="img"
        aria-label={title}
      >
        {line.thenY !== null && <line class="then" x1={0} x2={CHART_WIDTH} y1={line.thenY} y2={line.thenY} />}
        <polyline points={line.points} />
      </svg>
      <figcaption class="quiet">{title}</figcaption>
    </figure>
  );
}

function Changes({ outcome }: { outcome: RehearsalAnswer }) {
  const changes = possible(outcome)[0]?.changes ?? [];
  if (changes.length === 0) return <p>{text("no_changes")}</p>;
  return (
    <table class="stacked">
      <caption>{text("changes")}</caption>
      <Columns names={[text("person"), text("alarm_kind"), text("at_then"), text("at_rehearsed")]} />
      <tbody>
        {changes.map((one, place) => (
          <tr key={place}>
            <th scope="row">{person(one, outcome)}</th>
            <td data-label={text("alarm_kind")}>{levelLabel(one)}</td>
            <td data-label={text("at_then")}>{raisedAt(one.recorded_ms)}</td>
            <td data-label={text("at_rehearsed")}>{raisedAt(one.rehearsed_ms)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
