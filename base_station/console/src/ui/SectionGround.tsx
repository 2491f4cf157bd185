import { BAR_PX } from "../section/marks";
import { floor } from "../uiState";
import type { DrawnSection } from "../section/drawing";
import type { DrawnMark } from "../section/markDrawing";

interface Props {
  section: DrawnSection;
  widthPx: number;
}

/** Background of the section: ground, floors, stairs, and the uncertainty of each height. */
export function SectionGround({ section, widthPx }: Props) {
  const { heightPx, groundPx } = section;
  return (
    <svg class="section-ground" width={widthPx} height={heightPx} aria-hidden="true" focusable="false">
      <rect class="earth" x={0} y={groundPx} width={widthPx} height={Math.max(0, heightPx - groundPx)} />
      {section.floors.map((one) => {
        if (one.floor === null) return null;
        const kind = `storey ${one.expected ? "expected" : ""} ${one.floor === floor.value ? "shown" : ""}`;
        return (
          <g key={one.floor} class={kind}>
            <rect {...box(one)} />
            <line x1={one.leftPx} x2={one.rightPx} y1={one.bottomPx} y2={one.bottomPx} />
          </g>
        );
      })}
      {section.stairs.map((one, i) => (
        <g key={i} class="flight">
          <rect {...box(one)} />
          <polyline points={steps(one)} />
        </g>
      ))}
      <line class="ground" x1={0} x2={widthPx} y1={groundPx} y2={groundPx} />
      {section.floors.flatMap(({ marks }) => marks).map((mark) => (
        <Bar key={mark.key} mark={mark} markPx={section.markPx} />
      ))}
    </svg>
  );
}

type Box = Record<"leftPx" | "rightPx" | "topPx" | "bottomPx", number>;

function box({ leftPx, rightPx, topPx, bottomPx }: Box) {
  return { x: leftPx, y: topPx, width: Math.max(0, rightPx - leftPx), height: Math.max(0, bottomPx - topPx) };
}

const STEPS = 5;

function steps({ leftPx, rightPx, topPx, bottomPx }: Box): string {
  const [run, rise] = [(rightPx - leftPx) / STEPS, (bottomPx - topPx) / STEPS];
  const corners = Array.from({ length: STEPS }, (_, i) => {
    const [x, y] = [leftPx + i * run, bottomPx - (i + 1) * rise];
    return `${x},${y} ${x + run},${y}`;
  });
  return [`${leftPx},${bottomPx}`, ...corners].join(" ");
}

const CAP_PX = 3;
const BESIDE_PX = BAR_PX / 2;

/** The height with its error, left of the position; a line leads to a shifted mark. */
export function Bar({ mark, markPx }: { mark: DrawnMark; markPx: number }) {
  const { xPx, yPx, footXPx, footYPx, barTopPx, barBottomPx, urgency } = mark;
  const isAside = xPx !== footXPx || yPx !== footYPx - Math.round(markPx / 2);
  const x = isAside ? footXPx : footXPx - markPx / 2 - BESIDE_PX;
  const { isBarCut } = mark;
  const cap = (y: number) => `M${x - CAP_PX},${y}h${2 * CAP_PX}`;
  const caps = (isBarCut.top ? "" : cap(barTopPx)) + (isBarCut.bottom ? "" : cap(barBottomPx));
  return (
    <g class={`bar ${urgency} ${mark.old ? "old" : ""} ${mark.chosen ? "chosen" : ""}`}>
      <path d={`M${x},${barTopPx}V${barBottomPx}${caps}${cap(footYPx)}`} />
      {isAside && <path class="aside" d={`M${footXPx},${footYPx}L${xPx},${yPx}`} />}
    </g>
  );
}
