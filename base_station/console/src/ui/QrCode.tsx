const MARGIN = 4; // modules that a reader needs around it

/** Dark on white in every theme: that is how readers find it. */
export function QrCode({ rows, label }: { rows: readonly string[]; label: string }) {
  const side = rows.length + 2 * MARGIN;
  return (
    <svg
      class="qr-code"
      viewBox={`${-MARGIN} ${-MARGIN} ${side} ${side}`}
      shape-rendering="crispEdges"
      role="img"
      aria-label={label}
    >
      <rect x={-MARGIN} y={-MARGIN} width={side} height={side} fill="#fff" />
      <path d={rows.map(darkRuns).join("")} fill="#000" />
    </svg>
  );
}

/** A rectangle for each run of dark modules. */
function darkRuns(row: string, y: number): string {
  return [...row.matchAll(/1+/g)].map((run) => `M${run.index} ${y}h${run[0].length}v1h-${run[0].length}z`).join("");
}
