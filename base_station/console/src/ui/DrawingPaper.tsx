import { useSignal } from "@preact/signals";
import { useLayoutEffect, useRef } from "preact/hooks";
import { linesOf, pixelAt, type Line, type Paper, type Pixel, type Scale } from "../plan/drawing";
import type { Plan } from "../wire";
import { t } from "../language/translate";

const STEP = 0.005; // of the paper's width, for an arrow key

interface Props {
  paper: Paper;
  url: string | null; // of its picture
  points: readonly Pixel[]; // that give the scale
  lines: readonly Line[];
  scale: Scale | null;
  shown: Plan | null;
  floor: number;
  zoom: number; // 1: the whole paper is seen
  click: (at: Pixel) => void;
}

/** Takes clicks; by keys, arrows move a cross (with Shift ten times as far) and Enter clicks there. */
export function DrawingPaper({ paper, url, points, lines, scale, shown, floor, zoom, click }: Props) {
  const { width_px: width, height_px: height } = paper;
  const drawing = useRef<SVGSVGElement>(null);
  const cross = useSignal<Pixel | null>(null);
  const mark = width / 150;
  const press = (event: MouseEvent) => {
    const matrix = drawing.current?.getScreenCTM()?.inverse();
    if (!matrix) return;
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix);
    if (x >= 0 && y >= 0 && x <= width && y <= height) click({ x, y });
  };
  const key = (event: KeyboardEvent) => {
    const { x, y } = cross.value ?? { x: width / 2, y: height / 2 };
    const step = STEP * width * (event.shiftKey ? 10 : 1);
    const [right, down] = MOVES[event.key] ?? [0, 0];
    if (event.key === "Enter") click({ x, y });
    else if (right === 0 && down === 0) return;
    else cross.value = { x: within(x + right * step, width), y: within(y + down * step, height) };
    event.preventDefault();
  };
  useLayoutEffect(() => drawing.current?.scrollIntoView({ block: "end" }), []);
  const there = scale === null ? [] : linesOf(shown, floor);
  return (
    <div class="drawing-paper">
      <svg
        ref={drawing}
        viewBox={`0 0 ${width} ${height}`}
        style={{ width: `${zoom * 100}%`, height: `${zoom * 100}%` }}
        role="application"
        tabIndex={0}
        aria-label={t("plan.paper")}
        onClick={press}
        onKeyDown={key}
        onBlur={() => (cross.value = null)}
      >
        <rect width={width} height={height} fill="#fff" />
        {url !== null && <image href={url} width={width} height={height} />}
        {scale !== null &&
          there.map(({ line }, at) => (
            <polyline key={at} class="there" points={text(line.map((end) => pixelAt(scale, end)))} />
          ))}
        {lines.map(({ kind, points: ends }, at) => (
          <g key={at} class={kind}>
            {kind === "wall" ? <polyline points={text(ends)} /> : <polygon points={text(ends)} />}
            {ends.map((end, number) => (
              <circle key={number} cx={end.x} cy={end.y} r={mark / 2} />
            ))}
          </g>
        ))}
        {points.length === 2 && <polyline class="scale" points={text(points)} />}
        {points.map(({ x, y }, at) => (
          <circle key={at} class="scale" cx={x} cy={y} r={mark} />
        ))}
        {cross.value !== null && (
          <path
            class="cross"
            d={`M${cross.value.x - 2 * mark} ${cross.value.y}h${4 * mark}m${-2 * mark} ${-2 * mark}v${4 * mark}`}
          />
        )}
      </svg>
    </div>
  );
}

const MOVES: Record<string, readonly [number, number]> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};

function within(value: number, most: number): number {
  return Math.min(most, Math.max(0, value));
}

function text(points: readonly Pixel[]): string {
  return points.map(({ x, y }) => `${x.toFixed(1)},${y.toFixed(1)}`).join(" ");
}
