/** Draws the route of a rescuer to a casualty. */
import Feature from "ol/Feature";
import LineString from "ol/geom/LineString";
import VectorLayer from "ol/layer/Vector";
import VectorSource from "ol/source/Vector";
import { Stroke, Style } from "ol/style";
import type { Route } from "../api";
import type { FloorChoice } from "../uiState";
import { faint, type Colours } from "./colours";
import { routeLines } from "./routeLines";

const WIDTH_PX = 6;

export class RouteLayer {
  private readonly source = new VectorSource<Feature<LineString>>();
  readonly layer = new VectorLayer({ source: this.source });

  /** Faint on other floors than the chosen one; dashed without a known route. */
  show(route: Route | null, floor: FloorChoice, colours: Colours): void {
    this.source.clear(true);
    if (route === null) return;
    for (const { line, isHere } of routeLines(route, floor)) {
      const feature = new Feature(new LineString(line));
      const colour = isHere ? colours.chosen : faint(colours.chosen, 0.35);
      feature.setStyle([
        new Style({ stroke: new Stroke({ color: colours.halo, width: WIDTH_PX + 3 }) }),
        new Style({
          stroke: new Stroke({
            color: colour,
            width: WIDTH_PX,
            ...(route.known ? {} : { lineDash: [4, 14] }),
          }),
        }),
      ]);
      this.source.addFeature(feature);
    }
  }
}
