/** The page's colours for drawings on a canvas. */

export interface Colours {
  text: string;
  halo: string;
  quiet: string;
  wall: string;
  room: string;
  stairs: string;
  grid: string;
  immediate: string;
  soon: string;
  watch: string;
  normal: string;
  chosen: string;
}

const NAMES: Record<keyof Colours, string> = {
  text: "--text",
  halo: "--ground",
  quiet: "--quiet",
  wall: "--wall",
  room: "--room",
  stairs: "--stairs",
  grid: "--grid",
  immediate: "--immediate",
  soon: "--soon",
  watch: "--watch",
  normal: "--normal",
  chosen: "--chosen",
};

export function readColours(): Colours {
  const style = getComputedStyle(document.documentElement);
  const canvas = document.createElement("canvas").getContext("2d");
  const entries = Object.entries(NAMES).map(([key, name]) => [
    key,
    inSixDigits(style.getPropertyValue(name).trim(), canvas),
  ]);
  return Object.fromEntries(entries) as Colours;
}

/** `#rrggbb`: the built style sheet writes "red" for `#ff0000`. */
function inSixDigits(colour: string, canvas: CanvasRenderingContext2D | null): string {
  if (canvas === null) return colour;
  canvas.fillStyle = colour;
  return canvas.fillStyle;
}

/** A colour `#rrggbb` with another opacity. */
export function faint(colour: string, opacity: number): string {
  const alpha = Math.round(opacity * 255);
  return colour + alpha.toString(16).padStart(2, "0");
}
