/** Widths of texts in pixels, each measured once: names are placed anew many times a second. */
import { measureTextWidth } from "ol/render/canvas";

/** Whose age is written has a new name each second. */
const MOST = 2000;

export class TextWidths {
  private readonly known = new Map<string, number>();

  constructor(private readonly measure: (font: string, text: string) => number = measureTextWidth) {}

  of(font: string, text: string): number {
    const key = `${font} ${text}`;
    const known = this.known.get(key);
    if (known !== undefined) return known;
    if (this.known.size >= MOST) this.known.clear();
    const widthPx = this.measure(font, text);
    this.known.set(key, widthPx);
    return widthPx;
  }
}
