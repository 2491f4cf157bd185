/** Cache of small drawings: a mark or a name on the plan is drawn once, and then its pixels are copied. */
import type { Pixel } from "./names";

/** Enough for the marks, headings and names of some hundred people; labels with an age change each second. */
const MOST = 2000;

export type Context = CanvasRenderingContext2D | OffscreenCanvasRenderingContext2D;

/** Canvas of a sprite; tests replace it. */
export type Sheet = CanvasImageSource & { width: number; height: number };

export class Sprites {
  private readonly known = new Map<string, Sheet | null>();
  private ratio = 1;
  private look: unknown = null;

  constructor(private readonly make: (width: number, height: number, paint: (to: Context) => void) => Sheet | null = painted) {}

  /** Sprites belong to one pixel density and one theme; after a change all are drawn again. */
  begin(ratio: number, look: unknown): void {
    if (ratio === this.ratio && look === this.look) return;
    this.known.clear();
    this.ratio = ratio;
    this.look = look;
  }

  /** Copy the sprite of this key with its middle at a place of the page.  `paint` draws it about the middle the
   * first time.  `to` must not be scaled: whole pixels are copied fastest, and stay sharp. */
  draw(to: Context, key: string, [x, y]: Pixel, [width, height]: Pixel, paint: (to: Context) => void): void {
    const sheet = this.sheet(key, width, height, paint);
    if (sheet === null) return;
    const left = Math.round(x * this.ratio - sheet.width / 2);
    const top = Math.round(y * this.ratio - sheet.height / 2);
    to.drawImage(sheet, left, top);
  }

  private sheet(key: string, width: number, height: number, paint: (to: Context) => void): Sheet | null {
    const known = this.known.get(key);
    if (known !== undefined) return known;
    const { ratio } = this;
    const [right, down] = [Math.ceil(width * ratio), Math.ceil(height * ratio)];
    const made = this.make(right, down, (context) => {
      context.setTransform(ratio, 0, 0, ratio, right / 2, down / 2);
      paint(context);
    });
    if (this.known.size >= MOST) this.known.clear();
    this.known.set(key, made);
    return made;
  }
}

/** An image: a canvas would be copied before each time that it is drawn. */
function painted(width: number, height: number, paint: (to: Context) => void): Sheet | null {
  const canvas = new OffscreenCanvas(width, height);
  const context = canvas.getContext("2d");
  if (context === null) return null;
  paint(context);
  return canvas.transferToImageBitmap();
}
