/** The people that are drawn on the plan, and how each looks.  Pure. */
import { needsOf } from "../live/alarms";
import { guarded } from "../live/faults";
import { displayName, urgencyOf } from "../live/urgency";
import type { FloorChoice } from "../uiState";
import type { AlarmView, PositionView, TrailPoint, UnitView } from "../wire";
import { initials } from "../format";
import { t } from "../language/translate";
import type { Colours } from "./colours";
import { isOld, outline } from "./ellipse";
import { floorBadge, floorRemark, floorsUp } from "./floors";
import type { Mark } from "./marks";
import type { Screen } from "./names";
import { siteCoordinate } from "./site";
import { spanMs, trailLines } from "./trail";

export interface Scene {
  units: readonly UnitView[];
  alarms: ReadonlyMap<string, AlarmView>;
  trails: ReadonlyMap<string, readonly TrailPoint[]>;
  nowMs: number;
  silentMs: number;
  floor: FloorChoice;
  chosen: string | null;
  colours: Colours;
  screen: Screen;
}

/** A person to be drawn; places are `[east_m, north_m]`. */
export interface Shown {
  unitId: string;
  looks: Mark;
  centre: [number, number];
  border: [number, number][]; // of the region; empty where none is drawn
  trail: [number, number][][];
}

const HEADING_KNOWN_RAD = 0.8;
const LABEL_LIMIT = 12;

/** One that cannot be drawn affects no other. */
export function shownPeople(scene: Scene): Shown[] {
  const shown: Shown[] = [];
  for (const unit of scene.units) {
    guarded(() => t("plan.unit", { unit: unit.unit_id }), () => {
      const { position } = unit;
      if (position === null || !isShown(unit, position, scene)) return;
      const looks = markOf(unit, position, scene);
      const centre = siteCoordinate(position);
      const border = isMissed(unit, looks) ? outline(centre, position, scene.silentMs) : [];
      const walked = hasTrail(looks, scene) ? (scene.trails.get(unit.unit_id) ?? []) : [];
      const drawnMs = spanMs(looks.chosen, looks.urgency);
      const trail = trailLines(walked, scene.nowMs, scene.floor, drawnMs);
      shown.push({ unitId: unit.unit_id, looks, centre, border, trail });
    });
  }
  return shown;
}

/** People on the chosen or on an unknown floor; and on every floor the chosen member and members in
 * danger. */
function isShown(unit: UnitView, position: PositionView, scene: Scene): boolean {
  const danger = urgencyOf(unit, scene.alarms) === "immediate";
  return isHere(position, scene) || danger || unit.unit_id === scene.chosen;
}

function isHere({ floor }: PositionView, scene: Scene): boolean {
  return scene.floor === "all" || floor === null || floor === scene.floor;
}

/** The growing region since the last contact is drawn for missing members; not for a unit that was
 * switched off normally while its wearer was well. */
function isMissed(unit: UnitView, { urgency }: Mark): boolean {
  return unit.link === "live" || !unit.switched_off || urgency === "immediate";
}

/** Trails of many people would hide the plan: only those of members in danger and the chosen one remain. */
function hasTrail({ chosen, urgency }: Mark, { units }: Scene): boolean {
  return units.length <= LABEL_LIMIT || chosen || urgency === "immediate";
}

function markOf(unit: UnitView, position: PositionView, scene: Scene): Mark {
  const name = displayName(unit);
  const old = isOld(position, scene.nowMs) || position.reach.length > 0;
  return {
    name,
    initials: initials(name),
    urgency: urgencyOf(unit, scene.alarms),
    chosen: unit.unit_id === scene.chosen,
    down: needsOf(unit, scene.alarms).length > 0,
    old,
    ageMs: scene.nowMs - position.t_ms,
    floor: floorRemark(position, scene.floor, old),
    floorsUp: floorsUp(position, scene.floor),
    floorBadge: floorBadge(position, scene.floor),
    headingRad: position.heading_rad,
    headingKnown: position.heading_std_rad < HEADING_KNOWN_RAD,
  };
}
