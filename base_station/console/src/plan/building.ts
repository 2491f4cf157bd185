/** The building's plan as a layer: rooms, walls, doors and stairs of the chosen floor. */
import type { Extent } from "ol/extent";
import GeoJSON from "ol/format/GeoJSON";
import VectorLayer from "ol/layer/Vector";
import VectorSource from "ol/source/Vector";
import { Fill, Stroke, Style, Text } from "ol/style";
import type { FeatureLike } from "ol/Feature";
import { guarded } from "../live/faults";
import type { FloorChoice } from "../uiState";
import type { Plan } from "../wire";
import { t } from "../language/translate";
import type { Colours } from "./colours";
import { SITE } from "./site";

export class Building {
  private readonly source = new VectorSource();
  readonly layer: VectorLayer;
  private floor: FloorChoice = "all";

  constructor(private colours: Colours) {
    this.layer = new VectorLayer({
      source: this.source,
      style: (feature) => this.style(feature),
      declutter: true,
    });
  }

  show(plan: Plan | null): void {
    this.source.clear(true);
    if (plan === null) return;
    const format = new GeoJSON({ dataProjection: SITE, featureProjection: SITE });
    plan.features.forEach((feature, number) =>
      guarded(t("plan.feature", { number }), () => {
        this.source.addFeatures(format.readFeatures(feature));
      }),
    );
  }

  choose(floor: FloorChoice, colours: Colours): void {
    if (floor === this.floor && colours === this.colours) return;
    this.floor = floor;
    this.colours = colours;
    this.source.changed();
  }

  extent(): Extent | null {
    return this.source.getExtent() ?? null;
  }

  private style(feature: FeatureLike): Style | undefined {
    const on: unknown = feature.get("floor");
    if (this.floor !== "all" && typeof on === "number" && on !== this.floor) return undefined;
    switch (feature.get("kind")) {
      case "outline":
        return new Style({ stroke: new Stroke({ color: this.colours.wall, width: 3.5 }) });
      case "room":
        return this.area(this.colours.room, nameOf(feature));
      case "stairs":
        return this.area(this.colours.stairs, nameOf(feature) || t("drawing.stairs"));
      case "door":
        return new Style({ stroke: new Stroke({ color: this.colours.room, width: 4 }) });
      default:
        return new Style({
          stroke: new Stroke({ color: this.colours.wall, width: 2.5, lineCap: "square" }),
        });
    }
  }

  private area(colour: string, name: string): Style {
    return new Style({
      fill: new Fill({ color: colour }),
      stroke: new Stroke({ color: this.colours.wall, width: 1 }),
      text: new Text({
        text: name,
        font: "13px system-ui, sans-serif",
        fill: new Fill({ color: this.colours.quiet }),
        overflow: false,
      }),
    });
  }
}

function nameOf(feature: FeatureLike): string {
  const name: unknown = feature.get("name");
  return typeof name === "string" ? name : "";
}
