import { useLayoutEffect, useRef } from "preact/hooks";
import { shownTheme } from "../appearance";
import { knownMessage } from "../language/translate";
import type { DeferredTexts } from "../language/catalogue";
import { readColours, type Colours } from "../plan/colours";
import { drawArrow, drawMark, radiusOf, type Mark } from "../plan/marks";
import { drawPin } from "../plan/pins";
import { Regions } from "../plan/regions";

/** The marks of the plan, as the plan itself draws them. */
export function Legend() {
  return (
    <ul class="legend">
      {ENTRIES.map(([key, draw]) => (
        <li key={key}>
          <Swatch draw={draw} />
          {knownMessage("legend", key, {})}
        </li>
      ))}
    </ul>
  );
}

const [WIDTH_PX, HEIGHT_PX] = [72, 56];
type Draw = (context: CanvasRenderingContext2D, colours: Colours) => void;

/** The middle is the origin. */
function Swatch({ draw }: { draw: Draw }) {
  const target = useRef<HTMLCanvasElement>(null);
  const theme = shownTheme.value;
  useLayoutEffect(() => {
    const context = target.current?.getContext("2d");
    if (!context) return;
    const ratio = devicePixelRatio;
    context.canvas.width = WIDTH_PX * ratio;
    context.canvas.height = HEIGHT_PX * ratio;
    context.setTransform(ratio, 0, 0, ratio, (WIDTH_PX * ratio) / 2, (HEIGHT_PX * ratio) / 2);
    draw(context, readColours());
  }, [theme]);
  return <canvas ref={target} style={{ width: `${WIDTH_PX}px`, height: `${HEIGHT_PX}px` }} aria-hidden="true" />;
}

const MEMBER: Mark = {
  name: "",
  initials: "AB",
  urgency: "normal",
  down: false,
  chosen: false,
  old: false,
  ageMs: 0,
  floor: "",
  floorsUp: 0,
  floorBadge: "",
  headingRad: 0,
  headingKnown: true,
};

function mark(looks: Partial<Mark>): Draw {
  return (context, colours) => drawMark(context, { ...MEMBER, ...looks }, colours);
}

function region(old: boolean): Draw {
  return (context, colours) => {
    const looks = { ...MEMBER, old };
    new Regions().draw(context, [{ looks, border: ELLIPSE }], ([x = 0, y = 0]) => [8 * x, 8 * y], colours);
    drawMark(context, looks, colours);
  };
}

/** A small region, as of a few metres, has the most of its filling. */
const ELLIPSE = Array.from({ length: 33 }, (_, i) => {
  const angle = (i * Math.PI) / 16;
  return [4 * Math.cos(angle), 3 * Math.sin(angle)];
});

const ENTRIES: readonly (readonly [keyof DeferredTexts["legend"], Draw])[] = [
  [
    "member",
    (context, colours) => {
      drawMark(context, MEMBER, colours);
      drawArrow(context, Math.PI / 2, radiusOf(MEMBER), colours.normal, colours.halo);
    },
  ],
  ["warning", mark({ urgency: "soon" })],
  ["emergency", mark({ urgency: "immediate" })],
  ["chosen", mark({ chosen: true })],
  ["other_floor", mark({ floorsUp: 2, floorBadge: "▲2" })],
  ["region", region(false)],
  ["old", region(true)],
  ["pin", (context, colours) => drawPin(shifted(context), "used", colours.chosen, colours.halo)],
  ["pin_conflict", (context, colours) => drawPin(shifted(context), "conflict", colours.immediate, colours.halo)],
];

/** A pin stands above its place. */
function shifted(context: CanvasRenderingContext2D): CanvasRenderingContext2D {
  context.translate(0, 16);
  return context;
}
