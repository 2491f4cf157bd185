/** The lines of a timeline, one above the other; loaded when a timeline is opened. */
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { clockTime } from "../format";
import { STRIPS, type Span, type Strip, type Timeline } from "./series";

/** Moments that are marked. */
export interface Marks {
  /** Of a replay; null: what is live. */
  shownMs: number | null;
  /** Moment under the pointer; null: none. */
  lookedAtMs: number | null;
}

export interface Handlers {
  look(atMs: number | null): void;
  seek(atMs: number): void;
  zoom(span: Span): void;
}

const HEIGHT = 74;
const TALL = 116; // the one whose axis has words
const TIMES = 26; // more for the one with the times above it
const AXIS = 84;
const RIGHT = 14;
const LEAST_DRAG_PX = 6; // less is a press

export class Charts {
  private readonly plots: uPlot[];
  private marks: Marks = { shownMs: null, lookedAtMs: null };

  /** `places` have the lines, in the order of `STRIPS`. */
  constructor(
    private readonly places: readonly HTMLElement[],
    private readonly timeline: Timeline,
    private readonly handlers: Handlers,
  ) {
    this.plots = STRIPS.map((strip, number) => this.plot(strip, number));
  }

  mark(marks: Marks): void {
    this.marks = marks;
    for (const plot of this.plots) plot.redraw(false, false);
  }

  resize(): void {
    this.plots.forEach((plot, number) => {
      plot.setSize({ width: this.places[number]!.clientWidth, height: plot.height });
    });
  }

  destroy(): void {
    for (const plot of this.plots) plot.destroy();
  }

  private plot(strip: Strip, number: number): uPlot {
    const { t_ms, values } = this.timeline[strip.column];
    const place = this.places[number]!;
    const isFirst = number === 0;
    const height = strip.column === "activity" ? TALL : HEIGHT;
    const options: uPlot.Options = {
      width: place.clientWidth,
      height: isFirst ? height + TIMES : height,
      ms: 1,
      padding: [isFirst ? 0 : 8, RIGHT, 6, 0],
      legend: { show: false },
      cursor: {
        x: false,
        y: false,
        points: { show: false },
        drag: { x: true, y: false, setScale: false },
      },
      scales: {
        x: { time: true, range: () => [this.timeline.from_ms, this.timeline.until_ms] },
        y: { range: strip.range ?? rangeOf(strip) },
      },
      series: [{}, seriesOf(strip)],
      axes: [times(isFirst), this.valuesAxis(strip)],
      hooks: {
        ready: [(plot) => this.listen(plot)],
        drawClear: [(plot) => this.drawRadioGaps(plot)],
        draw: [(plot) => this.drawMarks(plot)],
        setCursor: [(plot) => this.handlers.look(timeAt(plot, plot.cursor.left ?? -1))],
        setSelect: [(plot) => this.zoomTo(plot)],
      },
    };
    return new uPlot(options, [[...t_ms], [...values]], place);
  }

  private valuesAxis(strip: Strip): uPlot.Axis {
    const tick = strip.tick ?? strip.text;
    return {
      size: AXIS,
      stroke: colour("--quiet"),
      grid: { stroke: colour("--grid") },
      ticks: { show: false },
      font: "12px system-ui, sans-serif",
      space: 22,
      values: (_, splits) => splits.map((value) => tick(tidy(value), this.timeline)),
      ...(strip.stepped ? { splits: (plot: uPlot) => distinct(plot.data[1]) } : {}),
    };
  }

  private listen(plot: uPlot): void {
    plot.over.addEventListener("click", () => {
      const atMs = timeAt(plot, plot.cursor.left ?? -1);
      if (atMs !== null) this.handlers.seek(atMs);
    });
  }

  private zoomTo(plot: uPlot): void {
    const { left, width } = plot.select;
    if (width < LEAST_DRAG_PX) return;
    plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    const [fromMs, untilMs] = [left, left + width].map((px) => plot.posToVal(px, "x"));
    this.handlers.zoom({ fromMs: fromMs!, untilMs: untilMs! });
  }

  private drawRadioGaps({ ctx, bbox }: uPlot): void {
    ctx.save();
    ctx.fillStyle = colour("--stairs");
    for (const [fromMs, untilMs] of this.timeline.radio_gaps_ms) {
      const [left, right] = [fromMs, untilMs].map((ms) => this.across(bbox, ms));
      ctx.fillRect(left!, bbox.top, right! - left!, bbox.height);
    }
    ctx.restore();
  }

  private drawMarks({ ctx, bbox }: uPlot): void {
    const { shownMs, lookedAtMs } = this.marks;
    const line = (ms: number | null, name: string, width: number) => {
      if (ms === null || ms < this.timeline.from_ms || ms > this.timeline.until_ms) return;
      ctx.fillStyle = colour(name);
      const px = width * devicePixelRatio;
      ctx.fillRect(this.across(bbox, ms) - px / 2, bbox.top, px, bbox.height);
    };
    ctx.save();
    line(lookedAtMs, "--quiet", 1);
    line(shownMs, "--replay", 3);
    ctx.restore();
  }

  /** Pixels of the canvas, within the plot. */
  private across({ left, width }: uPlot.BBox, ms: number): number {
    const { from_ms, until_ms } = this.timeline;
    const share = (ms - from_ms) / Math.max(until_ms - from_ms, 1);
    return left + width * Math.min(Math.max(share, 0), 1);
  }
}

function timeAt(plot: uPlot, px: number): number | null {
  return px < 0 ? null : Math.round(plot.posToVal(px, "x"));
}

function seriesOf(strip: Strip): uPlot.Series {
  const stepped = strip.stepped ? uPlot.paths.stepped?.({ align: 1 }) : undefined;
  return {
    stroke: colour("--accent"),
    width: 1.5,
    points: { size: 3 },
    ...(stepped === undefined ? {} : { paths: stepped }),
  };
}

/** Smallest range of the axis: a constant line is in the middle, and noise is not enlarged. */
function rangeOf(strip: Strip): uPlot.Range.Function {
  const room = strip.stepped ? 0.5 : 0;
  const least = strip.stepped ? 1 : 2;
  return (_, low, high) => {
    if (low === null || high === null) return [0, 1];
    const middle = (low + high) / 2;
    const half = Math.max((high - low) / 2 + room, least / 2);
    return strip.stepped ? [middle - half, middle + half] : uPlot.rangeNum(middle - half, middle + half, 0.05, true);
  };
}

function distinct(values: uPlot.AlignedData[number] | undefined): number[] {
  const known = [...(values ?? [])].filter((value) => typeof value === "number");
  return [...new Set(known)].sort((a, b) => a - b);
}

/** Without rounding errors of binary fractions. */
function tidy(value: number): number {
  return Math.round(value * 1000) / 1000;
}

function times(isFirst: boolean): uPlot.Axis {
  return {
    side: 0,
    size: isFirst ? TIMES : 0,
    stroke: colour("--quiet"),
    grid: { stroke: colour("--grid") },
    ticks: { show: false },
    font: "12px system-ui, sans-serif",
    space: 90,
    values: (_, splits) => splits.map((ms) => (isFirst ? clockTime(ms) : "")),
  };
}

function colour(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}
