/** A metre grid behind all layers: the background of the plan, and the only layer without one. */
import Layer from "ol/layer/Layer";
import type { FrameState } from "ol/Map";
import type { Colours } from "./colours";

const CLOSEST_PX = 40;
const STEPS = [1, 2, 5];

/** The distance between two lines, a round number of metres at least `CLOSEST_PX` apart. */
export function gridStepM(resolutionMPerPx: number): number {
  const least = CLOSEST_PX * resolutionMPerPx;
  const decade = 10 ** Math.floor(Math.log10(least));
  const factor = STEPS.find((step) => step * decade >= least) ?? 10;
  return factor * decade;
}

export class Grid extends Layer {
  private readonly canvas = document.createElement("canvas");

  constructor(private colours: Colours) {
    super({});
    this.canvas.className = "grid";
  }

  recolour(colours: Colours): void {
    this.colours = colours;
    this.changed();
  }

  override render(frame: FrameState | null): HTMLElement {
    if (frame === null) return this.canvas;
    const [width = 0, height = 0] = frame.size;
    this.canvas.width = width * frame.pixelRatio;
    this.canvas.height = height * frame.pixelRatio;
    const context = this.canvas.getContext("2d");
    if (context === null) return this.canvas;
    const { resolution, center } = frame.viewState;
    context.scale(frame.pixelRatio, frame.pixelRatio);
    context.strokeStyle = this.colours.grid;
    context.lineWidth = 1;
    context.beginPath();
    const stepPx = gridStepM(resolution) / resolution;
    for (const x of lines(width, stepPx, (center[0] ?? 0) / resolution)) {
      context.moveTo(x, 0);
      context.lineTo(x, height);
    }
    for (const y of lines(height, stepPx, -(center[1] ?? 0) / resolution)) {
      context.moveTo(0, y);
      context.lineTo(width, y);
    }
    context.stroke();
    return this.canvas;
  }
}

/** Positions of grid lines on an axis of `length` pixels whose middle is `centre` pixels from the origin. */
function lines(length: number, stepPx: number, centre: number): number[] {
  const first = centre - length / 2;
  const start = Math.ceil(first / stepPx) * stepPx - first;
  return Array.from(
    { length: Math.max(0, Math.ceil((length - start) / stepPx)) },
    (_, i) => Math.round(start + i * stepPx) + 0.5,
  );
}
