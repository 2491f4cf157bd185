import { useSignal, type Signal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { DrawnPicture } from "../api";
import {
  downOf,
  emptyPaper,
  isComplete,
  LEAST_PX,
  metresPerPixel,
  withFloor,
  type Line,
  type LineKind,
  type Pixel,
  type Scale,
} from "../plan/drawing";
import { blobOf } from "../plan/floorPicture";
import type { Plan } from "../wire";
import "../styles/setup.css";
import { number } from "../language/measures";
import { type PlainKey, t } from "../language/translate";
import { DrawingPaper } from "./DrawingPaper";
import { SendPlan } from "./SendPlan";

const KINDS: Record<LineKind, PlainKey> = {
  wall: "drawing.wall",
  outline: "drawing.outline",
  stairs: "drawing.stairs",
};

const MOST_ZOOM = 8;

interface Props {
  picture: DrawnPicture | null; // null: empty paper
  shown: Plan | null;
  name: string;
}

interface Given {
  length: string;
  floor: string;
  up: string;
  east: string;
  north: string;
}

/** Two points of a picture give its scale; walls are drawn on it by hand.  Empty paper has a scale. */
export function PlanDrawing({ picture, shown, name }: Props) {
  const empty = picture === null ? emptyPaper(shown) : null;
  const url = usePicture(picture);
  const points = useSignal<readonly Pixel[]>(empty === null ? [] : [empty.scale.one, empty.scale.other]);
  const given = useSignal<Given>({ length: "", floor: "0", up: "", east: "0", north: "0" });
  const lines = useSignal<readonly Line[]>([]);
  const begun = useSignal<Line>({ kind: "wall", points: [] });
  const zoom = useSignal(1);
  const floor = Number(given.value.floor);
  const down_m = given.value.up === "" ? downOf(shown, floor) : -Number(given.value.up);
  const scale = empty?.scale ?? scaleOf(points.value, given.value);
  const drawn = isComplete(begun.value) ? [...lines.value, begun.value] : lines.value;
  const paper = empty?.paper ?? { width_px: 1, height_px: 1, ...picture, webp: picture?.webp ?? null };
  const endLine = (kind: LineKind) => {
    lines.value = drawn;
    begun.value = { kind, points: [] };
  };
  const click = (at: Pixel) => {
    if (points.value.length < 2) points.value = [...points.value, at];
    else if (scale !== null) begun.value = { ...begun.value, points: [...begun.value.points, at] };
  };
  const undo = () => {
    if (begun.value.points.length > 0) {
      begun.value = { ...begun.value, points: begun.value.points.slice(0, -1) };
    } else if (lines.value.length > 0) {
      begun.value = lines.value.at(-1) ?? begun.value;
      lines.value = lines.value.slice(0, -1);
    } else if (empty === null) points.value = points.value.slice(0, -1);
  };
  const isEmpty = picture === null && drawn.length === 0;
  return (
    <section class="plan-drawing" aria-label={t("drawing.title")}>
      <Fields given={given} isScaled={empty !== null} down_m={down_m} />
      <div class="row" role="group" aria-label={t("drawing.what")}>
        {(Object.keys(KINDS) as LineKind[]).map((kind) => (
          <button
            key={kind}
            type="button"
            aria-pressed={begun.value.kind === kind}
            disabled={scale === null}
            onClick={() => endLine(kind)}
          >
            {t(KINDS[kind])}
          </button>
        ))}
        <button type="button" disabled={begun.value.points.length === 0} onClick={() => endLine(begun.value.kind)}>
          {t("drawing.end_line")}
        </button>
        <button type="button" onClick={undo}>
          {t("par.undo")}
        </button>
        <button type="button" disabled={zoom.value === MOST_ZOOM} onClick={() => (zoom.value *= 2)}>
          {t("drawing.larger")}
        </button>
        <button type="button" disabled={zoom.value === 1} onClick={() => (zoom.value /= 2)}>
          {t("drawing.smaller")}
        </button>
        {scale !== null && !isEmpty && (
          <SendPlan
            plan={withFloor(shown, { floor, down_m, paper, scale, lines: drawn }, name)}
            replaces={shown !== null}
          />
        )}
      </div>
      <p role="status">{hint(points.value, scale, empty !== null)}</p>
      <DrawingPaper
        paper={paper}
        url={url}
        points={empty === null ? points.value : []}
        lines={[...lines.value, begun.value]}
        scale={scale}
        shown={shown}
        floor={floor}
        zoom={zoom.value}
        click={click}
      />
    </section>
  );
}

/** The address of the picture, while it is looked at. */
function usePicture(picture: DrawnPicture | null): string | null {
  const url = useSignal<string | null>(null);
  useEffect(() => {
    if (picture === null) return undefined;
    const made = URL.createObjectURL(blobOf(picture.webp));
    url.value = made;
    return () => URL.revokeObjectURL(made);
  }, [picture]);
  return url.value;
}

function scaleOf([one, other]: readonly Pixel[], given: Given): Scale | null {
  const length_m = Number(given.length);
  if (one === undefined || other === undefined || !(length_m > 0)) return null;
  if (Math.hypot(other.x - one.x, other.y - one.y) < LEAST_PX) return null;
  return { one, other, length_m, east_m: Number(given.east), north_m: Number(given.north) };
}

function hint([one, other]: readonly Pixel[], scale: Scale | null, isPaper: boolean): string {
  if (isPaper) return t("drawing.hint_walls");
  if (one === undefined) return t("drawing.hint_first");
  if (other === undefined) return t("drawing.hint_second");
  if (Math.hypot(other.x - one.x, other.y - one.y) < LEAST_PX) {
    return t("drawing.hint_near");
  }
  if (scale === null) return t("drawing.hint_distance");
  return t("drawing.hint_scale", { pixels: number(1 / metresPerPixel(scale), 1) });
}

interface FieldsProps {
  given: Signal<Given>;
  isScaled: boolean;
  down_m: number;
}

function Fields({ given, isScaled, down_m }: FieldsProps) {
  const field = (name: keyof Given, label: string, more: object) => (
    <label>
      {label}
      <input
        type="number"
        step="any"
        value={given.value[name]}
        onInput={(event) => (given.value = { ...given.value, [name]: event.currentTarget.value })}
        {...more}
      />
    </label>
  );
  return (
    <>
      <div class="row">
        {!isScaled && field("length", t("drawing.distance"), { min: 0, autofocus: true })}
        {field("floor", t("drawing.floor"), { step: 1, min: -1000, max: 1000 })}
        {field("up", t("drawing.height"), { placeholder: String(-down_m) })}
      </div>
      {!isScaled && (
        <details>
          <summary>{t("drawing.first_point")}</summary>
          <div class="row">
            {field("east", t("drawing.east"), {})}
            {field("north", t("drawing.north"), {})}
          </div>
          <p class="quiet">{t("drawing.first_hint")}</p>
        </details>
      )}
    </>
  );
}
