/** Invisible copies of people's names in the map's own layers, so that names of rooms and of other teams
 * avoid them. */
import Feature from "ol/Feature";
import Point from "ol/geom/Point";
import VectorLayer from "ol/layer/Vector";
import VectorSource from "ol/source/Vector";
import { Fill, Style, Text } from "ol/style";
import { labelFont, labelOf } from "./marks";
import type { Place } from "./names";
import type { Shown } from "./peopleScene";

/** The whole map is drawn again with them. */
const EVERY_MS = 1000;
const UNSEEN = new Fill({ color: "rgba(0, 0, 0, 0)" });

export class NameObstacles {
  private readonly source = new VectorSource<Feature<Point>>();
  readonly layer = new VectorLayer({ source: this.source, declutter: true });
  private shownMs = -EVERY_MS;
  private isEmpty = true;

  /** `nowMs`: by a clock that only goes forward. */
  show(people: readonly (Shown & { name: Place | null })[], nowMs: number): void {
    if (nowMs - this.shownMs < EVERY_MS) return;
    const named = people.flatMap(({ name, looks, centre }) => {
      if (name === null) return [];
      const [offsetX, offsetY] = name.offset;
      const feature = new Feature(new Point(centre));
      const text = new Text({
        text: labelOf(looks),
        font: labelFont(looks),
        offsetX,
        offsetY,
        fill: UNSEEN,
        padding: [1, 3, 1, 3],
        declutterMode: "obstacle",
      });
      feature.setStyle(new Style({ text }));
      return [feature];
    });
    if (named.length === 0 && this.isEmpty) return;
    this.shownMs = nowMs;
    this.isEmpty = named.length === 0;
    this.source.clear(true);
    this.source.addFeatures(named);
  }
}
