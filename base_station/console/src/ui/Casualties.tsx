import { select, selectedUnit } from "../uiState";
import { needsOf } from "../live/alarms";
import type { Picture } from "../live/picture";
import { displayName } from "../live/urgency";
import { isOld } from "../plan/ellipse";
import type { UnitView } from "../wire";
import * as format from "../format";
import { Icon } from "./Icon";
import { useGuardedPress } from "./useGuardedPress";

/** More than this have a line each in which there is room for the name alone. */
const MANY = 6;

/** Members who are down, above the list however far it is scrolled, each with what is the matter and where. */
export function Casualties({ unitIds, picture }: { unitIds: readonly string[]; picture: Picture }) {
  if (unitIds.length === 0) return null;
  const many = unitIds.length > MANY ? "many" : "";
  return (
    <ul class={`casualties ${many}`} aria-label="Members who are down">
      {unitIds.map((unitId, place) => (
        <Casualty key={unitId} unitId={unitId} place={place} picture={picture} />
      ))}
    </ul>
  );
}

interface Props {
  unitId: string;
  place: number;
  picture: Picture;
}

function Casualty({ unitId, place, picture }: Props) {
  const unit = picture.unit(unitId)?.value;
  const steady = useGuardedPress(place);
  if (unit === undefined) return null;
  const name = displayName(unit);
  const matter = needsOf(unit, picture.alarms.value).map(format.alarmLabel).join(", ");
  const words = [placeOf(unit, picture.nowMs.value), matter || format.activityOf(unit)].join(" · ");
  return (
    <li>
      <button
        type="button"
        aria-pressed={selectedUnit.value === unitId}
        title={`${name}: ${words}. Show on the plan`}
        onClick={steady(() => select(unitId, unit.position?.floor ?? null))}
      >
        <Icon name="alarm" />
        <span class="casualty-name">{name}</span>
        <span class="casualty-words">{words}</span>
      </button>
    </li>
  );
}

/** In short: the card says the rest. */
function placeOf({ position }: UnitView, nowMs: number): string {
  if (position === null) return "not located";
  const floor = format.isFloorLikely(position) ? position.floor : null;
  return format.floorName(floor) + (isOld(position, nowMs) ? ", old" : "");
}
