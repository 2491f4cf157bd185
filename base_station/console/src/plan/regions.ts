/** Drawing of the 95 % regions of people: an ellipse, or the part within the walls. */
import type { Coordinate } from "ol/coordinate";
import { boundingExtent } from "ol/extent";
import { faint, type Colours } from "./colours";
import { colourOf, type Mark } from "./marks";
import type { Pixel } from "./names";
import type { Context } from "./sprites";

export interface DrawnRegion {
  looks: Mark;
  border: readonly Coordinate[]; // closed; empty where none is to be drawn
}

/** Old regions of more people than this, of one colour, are drawn as one: each takes as long as a filled
 * screen, and together they would hide the plan. */
export const MOST_ALONE = 12;
const HATCH_PX = 12;
const MOST_FILLING = 0.18;
const FULL_RADIUS_M = 3; // up to here a region has all of its filling
const MOST_HATCHING = 0.3;
const FULL_HATCHING_M = 20; // the same of an old one's hatching
const CROWD_HATCHING = 0.15;
const CROWD_BORDER = 0.35;
/** A browser without a graphics card draws a line of one pixel six times as fast as a wider one. */
const BORDER_PX = 1;
const CHOSEN_BORDER_PX = 2.5;

/** A place of the site on the page. */
export type PixelOf = (coordinate: Coordinate) => Pixel;

export class Regions {
  private readonly patterns = new Map<string, CanvasPattern | string>();

  draw(context: Context, regions: readonly DrawnRegion[], pixelOf: PixelOf, colours: Colours): void {
    const { alone, crowds } = parted(regions, colours);
    context.save();
    for (const one of alone) this.drawAlone(context, one, pixelOf, colours);
    for (const [colour, borders] of crowds) this.drawCrowd(context, colour, borders, pixelOf);
    context.restore();
  }

  private drawAlone(context: Context, { looks, border }: DrawnRegion, pixelOf: PixelOf, colours: Colours): void {
    const colour = colourOf(looks, colours);
    const opacity = filling(looks, radiusOf(border));
    context.beginPath();
    traceRing(context, border, pixelOf);
    context.fillStyle = looks.old ? this.hatching(colour, opacity) : faint(colour, opacity);
    context.fill();
    context.setLineDash(looks.old ? [6, 5] : []);
    context.strokeStyle = colour;
    context.lineWidth = looks.chosen ? CHOSEN_BORDER_PX : BORDER_PX;
    context.stroke();
  }

  /** One filling for all, not darker where regions overlap; without dashes, as those of a hundred wide
   * borders take seconds. */
  private drawCrowd(
    context: Context,
    colour: string,
    borders: readonly (readonly Coordinate[])[],
    pixelOf: PixelOf,
  ): void {
    context.beginPath();
    // Always in the same direction, so that no overlap of two is a hole.
    for (const border of borders) {
      traceRing(context, turnsLeft(border) ? border : [...border].reverse(), pixelOf);
    }
    context.fillStyle = this.hatching(colour, CROWD_HATCHING);
    context.fill();
    context.setLineDash([]);
    context.strokeStyle = faint(colour, CROWD_BORDER);
    context.lineWidth = BORDER_PX;
    context.stroke();
  }

  private hatching(colour: string, opacity: number): CanvasPattern | string {
    const painted = faint(colour, opacity);
    const known = this.patterns.get(painted);
    if (known !== undefined) return known;
    const pattern = hatched(painted);
    this.patterns.set(painted, pattern);
    return pattern;
  }
}

/** Regions that are drawn separately, and the borders of the others by colour. */
export function parted(
  regions: readonly DrawnRegion[],
  colours: Colours,
): { alone: DrawnRegion[]; crowds: Map<string, (readonly Coordinate[])[]> } {
  const drawn = regions.filter(({ border }) => border.length > 0);
  const byColour = new Map<string, DrawnRegion[]>();
  for (const one of drawn) {
    if (!one.looks.old || one.looks.chosen) continue;
    const colour = colourOf(one.looks, colours);
    byColour.set(colour, [...(byColour.get(colour) ?? []), one]);
  }
  const crowds = [...byColour].filter(([, members]) => members.length > MOST_ALONE);
  const inCrowd = new Set(crowds.flatMap(([, members]) => members));
  return {
    alone: drawn.filter((one) => !inCrowd.has(one)),
    crowds: new Map(crowds.map(([colour, members]) => [colour, members.map((one) => one.border)])),
  };
}

/** The larger a region, the fainter its filling: many large ones must not hide the plan. */
export function filling({ old }: Pick<Mark, "old">, radiusM: number): number {
  const [most, fullM] = old ? [MOST_HATCHING, FULL_HATCHING_M] : [MOST_FILLING, FULL_RADIUS_M];
  return (most * fullM) / Math.max(radiusM, fullM);
}

function radiusOf(border: readonly Coordinate[]): number {
  const [west = 0, south = 0, east = 0, north = 0] = boundingExtent([...border]);
  return Math.max(east - west, north - south) / 2;
}

function traceRing(context: Context, border: readonly Coordinate[], pixelOf: PixelOf): void {
  border.forEach((at, i) => {
    const [x, y] = pixelOf(at);
    if (i === 0) context.moveTo(x, y);
    else context.lineTo(x, y);
  });
  context.closePath();
}

export function turnsLeft(border: readonly Coordinate[]): boolean {
  let doubleArea = 0;
  for (let i = 1; i < border.length; i++) {
    const [[x0 = 0, y0 = 0] = [], [x1 = 0, y1 = 0] = []] = [border[i - 1], border[i]];
    doubleArea += x0 * y1 - x1 * y0;
  }
  return doubleArea > 0;
}

function hatched(colour: string): CanvasPattern | string {
  const tile = document.createElement("canvas");
  tile.width = tile.height = HATCH_PX;
  const context = tile.getContext("2d");
  if (context === null) return colour;
  context.strokeStyle = colour;
  context.lineWidth = 1.2;
  context.beginPath();
  for (const x of [-HATCH_PX, 0, HATCH_PX]) {
    context.moveTo(x, HATCH_PX);
    context.lineTo(x + HATCH_PX, 0);
  }
  context.stroke();
  return context.createPattern(tile, "repeat") ?? colour;
}
