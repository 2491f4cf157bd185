/** People on the plan, on a canvas of their own: when they move, nothing else of the map is drawn again. */
import { boundingExtent, containsXY, createEmpty, extend, intersects, type Extent } from "ol/extent";
import Layer from "ol/layer/Layer";
import type { FrameState } from "ol/Map";
import type { Colours } from "./colours";
import {
  colourOf,
  drawArrow,
  drawMark,
  drawName,
  HALO_PX,
  isStrong,
  labelFont,
  labelOf,
  looksOf,
  MARK_REACH_PX,
  radiusOf,
  rankOf,
  trailLook,
} from "./marks";
import { NameObstacles } from "./nameObstacles";
import { BESIDE, boxesOf, placeNames, type Box, type Named, type Pixel, type Place, type Side } from "./names";
import { shownPeople, type Scene, type Shown } from "./peopleScene";
import { Regions, type PixelOf } from "./regions";
import { Sprites, type Context } from "./sprites";
import { TextWidths } from "./textWidths";

/** A heading is drawn to five degrees. */
const HEADINGS = 72;
const LINE_PX = 20;

/** A member in danger, as drawn. */
export interface Endangered {
  unitId: string;
  name: string;
  initials: string;
  centre: [number, number];
}

/** As drawn, with the position of the name; null: none. */
interface Drawn extends Shown {
  name: Place | null;
}

export class PeopleLayer extends Layer {
  /** As last shown. */
  endangered: readonly Endangered[] = [];
  readonly obstacles = new NameObstacles();
  private readonly canvas = document.createElement("canvas");
  private readonly sprites = new Sprites();
  private readonly widths = new TextWidths();
  private readonly regions = new Regions();
  private readonly sides = new Map<string, Side>(); // on which each name stands
  private drawn: readonly Drawn[] = [];
  private colours: Colours | null = null;
  private frame: FrameState | null = null; // the newest of the map

  constructor() {
    super({});
    this.canvas.className = "people-canvas";
  }

  /** Returns the areas of the screen that people and their names cover. */
  show(scene: Scene): Box[] {
    const all = shownPeople(scene);
    const named = all.map(({ unitId, centre, looks }): Named => ({
      mark: scene.screen.pixelOf(centre) ?? BESIDE,
      widthPx: this.widths.of(labelFont(looks), labelOf(looks)),
      strong: isStrong(looks),
      first: looks.chosen || looks.down,
      before: this.sides.get(unitId) ?? null,
    }));
    const places = placeNames(named, scene.screen);
    this.drawn = all.map((one, i) => ({ ...one, name: places[i] ?? null }));
    this.sides.clear();
    for (const { unitId, name } of this.drawn) if (name !== null) this.sides.set(unitId, name.side);
    this.endangered = all
      .filter(({ looks }) => looks.urgency === "immediate")
      .map(({ unitId, looks: { name, initials }, centre }) => ({ unitId, name, initials, centre }));
    this.colours = scene.colours;
    this.obstacles.show(this.drawn, performance.now());
    if (this.frame === null) this.changed();
    else this.paint(this.frame);
    return named.flatMap((one, i) => boxesOf(one, places[i] ?? null));
  }

  /** Extent of the people without their regions; null: no person is shown. */
  extent(): Extent | null {
    if (this.drawn.length === 0) return null;
    return extend(createEmpty(), boundingExtent(this.drawn.map(({ centre }) => centre)));
  }

  /** The unit whose mark is nearest to a coordinate, and where it is. */
  nearest([x = 0, y = 0]: number[]): { unitId: string; at: number[] } | null {
    let [best, leastM]: [Drawn | null, number] = [null, Infinity];
    for (const one of this.drawn) {
      const apartM = Math.hypot(one.centre[0] - x, one.centre[1] - y);
      if (apartM < leastM) [best, leastM] = [one, apartM];
    }
    return best === null ? null : { unitId: best.unitId, at: best.centre };
  }

  /** Drawn with the rest of the map while that is moved. */
  override render(frame: FrameState | null): HTMLElement {
    if (frame === null) return this.canvas;
    this.frame = frame;
    this.paint(frame);
    return this.canvas;
  }

  private paint({ size, extent, pixelRatio, coordinateToPixelTransform }: FrameState): void {
    const context = this.canvas.getContext("2d");
    const { colours } = this;
    if (context === null || colours === null) return;
    const [width = 0, height = 0] = size;
    fit(this.canvas, context, Math.round(width * pixelRatio), Math.round(height * pixelRatio));
    const [a = 1, b = 0, c = 0, d = 1, e = 0, f = 0] = coordinateToPixelTransform;
    const pixelOf: PixelOf = ([x = 0, y = 0]) => [a * x + c * y + e, b * x + d * y + f];
    context.setTransform(pixelRatio, 0, 0, pixelRatio, 0, 0);
    const regions = this.drawn.filter(({ border }) => isSeen(border, extent));
    this.regions.draw(context, regions, pixelOf, colours);
    for (const one of this.drawn) drawTrail(context, one, pixelOf, colours);
    context.setTransform(1, 0, 0, 1, 0, 0);
    this.sprites.begin(pixelRatio, colours);
    const near = [-MARK_REACH_PX, -MARK_REACH_PX, width + MARK_REACH_PX, height + MARK_REACH_PX];
    const seen = this.drawn.filter(({ centre }) => containsXY(near, ...pixelOf(centre)));
    seen.sort((one, other) => rankOf(one.looks) - rankOf(other.looks));
    for (const one of seen) this.drawMark(context, one, pixelOf(one.centre), colours);
    for (const one of seen) this.drawName(context, one, pixelOf(one.centre), colours);
  }

  private drawMark(context: Context, { looks }: Drawn, at: Pixel, colours: Colours): void {
    const size: Pixel = [2 * MARK_REACH_PX, 2 * MARK_REACH_PX];
    if (looks.headingKnown && !looks.old) {
      const [radiusPx, colour] = [radiusOf(looks), colourOf(looks, colours)];
      const step = Math.round((looks.headingRad / (2 * Math.PI)) * HEADINGS);
      this.sprites.draw(context, `heading ${step} ${radiusPx} ${colour}`, at, size, (sheet) =>
        drawArrow(sheet, (step / HEADINGS) * 2 * Math.PI, radiusPx, colour, colours.halo),
      );
    }
    this.sprites.draw(context, `mark ${looksOf(looks)}`, at, size, (sheet) => drawMark(sheet, looks, colours));
  }

  private drawName(context: Context, { looks, name }: Drawn, [x, y]: Pixel, colours: Colours): void {
    if (name === null) return;
    const [right, down] = name.offset;
    const font = labelFont(looks);
    const text = labelOf(looks);
    const size: Pixel = [this.widths.of(font, text) + 2 * HALO_PX, LINE_PX + 2 * HALO_PX];
    this.sprites.draw(context, `name ${font} ${text}`, [x + right, y + down], size, (sheet) =>
      drawName(sheet, looks, colours),
    );
  }
}

/** Empty, and as large as the map. */
function fit(canvas: HTMLCanvasElement, context: Context, width: number, height: number): void {
  if (canvas.width !== width || canvas.height !== height) {
    canvas.width = width;
    canvas.height = height;
    return;
  }
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.clearRect(0, 0, width, height);
}

/** Whether a part of a border may be in the part of the site that is on the screen. */
function isSeen(border: [number, number][], onScreen: Extent | null): boolean {
  return border.length > 0 && onScreen !== null && intersects(boundingExtent(border), onScreen);
}

function drawTrail(context: Context, { looks, trail }: Drawn, pixelOf: PixelOf, colours: Colours): void {
  if (trail.length === 0) return;
  const { color, widthPx } = trailLook(looks, colours);
  context.beginPath();
  for (const line of trail) {
    line.forEach((at, i) => {
      const [x, y] = pixelOf(at);
      if (i === 0) context.moveTo(x, y);
      else context.lineTo(x, y);
    });
  }
  context.lineCap = context.lineJoin = "round";
  context.strokeStyle = color;
  context.lineWidth = widthPx;
  context.stroke();
}
