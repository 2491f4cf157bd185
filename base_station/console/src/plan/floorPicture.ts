/** The picture of the floor that is shown, under its walls. */
import { createEmpty, extend, type Extent } from "ol/extent";
import { guarded } from "../live/faults";
import type { FloorChoice } from "../uiState";
import type { Plan } from "../wire";
import { t } from "../language/translate";
import { PictureLayer, type Corners } from "./pictureLayer";
import type { FloorPicture } from "./planFile";

export class FloorPictureLayer extends PictureLayer {
  private pictures: readonly FloorPicture[] = [];
  private shown: FloorPicture | null = null;
  private floor: FloorChoice = "all";
  private url: string | null = null;

  constructor() {
    super("base-map floor-picture", 0.7);
  }

  showPlan(plan: Plan | null): void {
    const pictures: unknown = plan?.muster.pictures;
    this.pictures = Array.isArray(pictures) ? pictures.filter(isPicture) : [];
    this.look();
  }

  choose(floor: FloorChoice): void {
    if (floor === this.floor) return;
    this.floor = floor;
    this.look();
  }

  extent(): Extent | null {
    if (this.pictures.length === 0) return null;
    const all = createEmpty();
    for (const one of this.pictures) {
      const [upperRight, lowerLeft] = [one.upper_right_m, one.lower_left_m];
      extend(all, [
        Math.min(upperRight[0], lowerLeft[0]),
        Math.min(upperRight[1], lowerLeft[1]),
        Math.max(upperRight[0], lowerLeft[0]),
        Math.max(upperRight[1], lowerLeft[1]),
      ]);
    }
    return all;
  }

  /** With all floors shown, the picture of the ground floor, or of the nearest one. */
  private look(): void {
    const byHeight = [...this.pictures].sort((a, b) => Math.abs(a.floor) - Math.abs(b.floor));
    const wanted = this.floor === "all" ? byHeight[0] : byHeight.find((one) => one.floor === this.floor);
    if (wanted === (this.shown ?? undefined)) return;
    this.shown = wanted ?? null;
    guarded(t("plan.floor_picture"), () => this.draw(wanted ?? null));
  }

  private draw(wanted: FloorPicture | null): void {
    if (this.url !== null) URL.revokeObjectURL(this.url);
    this.url = wanted === null ? null : URL.createObjectURL(blobOf(wanted.webp));
    this.place(this.url, wanted === null ? null : cornersOf(wanted));
  }
}

/** Plans of earlier versions may contain any value here. */
function isPicture(one: unknown): one is FloorPicture {
  const { webp, upper_left_m, upper_right_m, lower_left_m } = (one ?? {}) as Partial<FloorPicture>;
  return typeof webp === "string" && [upper_left_m, upper_right_m, lower_left_m].every(Array.isArray);
}

export function blobOf(webp: string): Blob {
  const bytes = Uint8Array.from(atob(webp), (letter) => letter.charCodeAt(0));
  return new Blob([bytes], { type: "image/webp" });
}

function cornersOf(picture: FloorPicture): Corners {
  const place = ([east_m, north_m]: [number, number]) => ({ east_m, north_m });
  return [place(picture.upper_left_m), place(picture.upper_right_m), place(picture.lower_left_m)];
}
