/** A picture drawn on the plan, wherever three of its corners lie. */
import Layer from "ol/layer/Layer";
import type { FrameState } from "ol/Map";
import type { Place } from "./tools";

type Pixel = [number, number];
export type Corners = readonly [Place, Place, Place]; // upper left, upper right, lower left

export class PictureLayer extends Layer {
  private readonly canvas = document.createElement("canvas");
  private readonly image = new Image();
  private corners: Corners | null = null;

  constructor(className: string, opacity: number) {
    super({ opacity });
    this.canvas.className = className;
    this.image.addEventListener("load", () => this.changed());
  }

  /** Null corners: nothing is drawn. */
  place(url: string | null, corners: Corners | null): void {
    this.corners = corners;
    if (url !== null && !this.image.src.endsWith(url)) this.image.src = url;
    this.changed();
  }

  override render(frame: FrameState | null): HTMLElement {
    if (frame === null) return this.canvas;
    const [width = 0, height = 0] = frame.size;
    this.canvas.width = width * frame.pixelRatio;
    this.canvas.height = height * frame.pixelRatio;
    const context = this.canvas.getContext("2d");
    if (context === null || this.corners === null || this.image.naturalWidth === 0) {
      return this.canvas;
    }
    const { resolution, center } = frame.viewState;
    const pixel = ({ north_m, east_m }: Place): Pixel => [
      width / 2 + (east_m - (center[0] ?? 0)) / resolution,
      height / 2 - (north_m - (center[1] ?? 0)) / resolution,
    ];
    const [upperLeft, upperRight, lowerLeft] = this.corners.map(pixel) as [Pixel, Pixel, Pixel];
    const [columns, rows] = [this.image.naturalWidth, this.image.naturalHeight];
    context.scale(frame.pixelRatio, frame.pixelRatio);
    context.globalAlpha = frame.layerStatesArray[frame.layerIndex]?.opacity ?? 1;
    context.transform(
      (upperRight[0] - upperLeft[0]) / columns,
      (upperRight[1] - upperLeft[1]) / columns,
      (lowerLeft[0] - upperLeft[0]) / rows,
      (lowerLeft[1] - upperLeft[1]) / rows,
      upperLeft[0],
      upperLeft[1],
    );
    context.drawImage(this.image, 0, 0);
    return this.canvas;
  }
}
