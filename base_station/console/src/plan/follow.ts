/** Updates the plan to the picture, a few times a second at most. */
import { computed, effect } from "@preact/signals";
import { shownTheme } from "../appearance";
import { units } from "../language/measures";
import { guarded } from "../live/faults";
import { floor, selectedUnit } from "../uiState";
import type { Picture } from "../live/picture";
import { drawnRoute, rescue } from "../live/rescue";
import { displayName } from "../live/urgency";
import type { TrailPoint } from "../wire";
import { type PlainKey, t } from "../language/translate";
import { followBaseMap } from "./baseMap";
import { beginOnAFloor } from "./floorShown";
import { areImportsShown, followImports, imports } from "./imports";
import type { PlanMap } from "./map";
import { followTrails, pastTrails, shownKinds } from "./pastTrails";
import { atMostEvery, redrawMs } from "./redrawing";
import { clicked, tool } from "./tools";

const NO_TRAILS = new Map<string, readonly TrailPoint[]>();

/** Starts the updates; the returned function ends them. */
export function follow(map: PlanMap, picture: Picture): () => void {
  const redraw = atMostEvery(redrawMs, () =>
    guarded(t("frame.plan"), () =>
      map.showPeople({
        units: picture.allUnits(),
        alarms: picture.alarms.peek(),
        trails: shownKinds.peek().has("fused") ? picture.trails.peek() : NO_TRAILS,
        nowMs: picture.nowMs.peek(),
        silentMs: picture.silentMs.peek(),
        floor: floor.peek(),
        chosen: selectedUnit.peek(),
      }),
    ),
  );
  const siteId = computed(() => picture.incident.value?.site_id ?? "");
  const drawPins = () => {
    void shownTheme.value;
    map.showPins({
      pins: picture.pins.value,
      beacons: picture.beacons.value,
      names: new Map(picture.allUnits().map((unit) => [unit.unit_id, displayName(unit)])),
      floor: floor.value,
      chosen: chosenOnPlan(),
      clicked: clicked.value,
    });
  };
  const ends = [
    () => redraw.cancel(),
    following("plan.colours", () => {
      void shownTheme.value; // what is drawn below with these colours looks at it too, and later
      map.recolour();
    }),
    following("plan.scale", () => map.showUnits(units.value)),
    following("plan.building", () => {
      void siteId.value; // another ground without a plan is another place all the same
      map.showPlan(picture.plan.value);
    }),
    followBaseMap(map.ground, () => picture.anchor.value),
    effect(() => {
      void [picture.unitsChanged.value, picture.alarms.value, picture.plan.value];
      void [picture.nowMs.value, floor.value, selectedUnit.value, shownKinds.value];
      void [pastTrails.value, shownTheme.value];
      redraw.ask();
    }),
    following("plan.pins", drawPins),
    following("plan.trails", () => {
      void shownTheme.value;
      map.showPast({
        past: pastTrails.value,
        shown: picture.trails.peek(),
        nowMs: picture.nowMs.value,
        floor: floor.value,
        chosen: selectedUnit.value,
      });
    }),
    following("plan.way", () => {
      void shownTheme.value;
      const now = rescue.value;
      map.showRoute(now === null ? null : drawnRoute(now), floor.value);
    }),
    following("plan.others", () => {
      void shownTheme.value;
      map.showExternal({ external: picture.external.value, nowMs: picture.nowMs.value });
    }),
    following("imports.layer", () => {
      void shownTheme.value;
      map.showImports({
        imports: areImportsShown.value ? imports.value : [],
        nowMs: picture.nowMs.value,
        floor: floor.value,
      });
    }),
    followTrails(picture),
    followImports(picture),
    beginOnAFloor(picture),
  ];
  return () => ends.forEach((end) => end());
}

/** A failing effect affects no other, and is tried again with the next change. */
function following(what: PlainKey, work: () => void): () => void {
  return effect(() => {
    guarded(t(what), work);
  });
}

/** The selected pin or beacon. */
function chosenOnPlan(): string | null {
  const now = tool.value;
  if (now?.kind === "edit-pin") return now.pinId;
  return now?.kind === "edit-beacon" ? now.beaconId : null;
}
