import { select, selectedUnit } from "../uiState";
import { listed } from "../language/measures";
import { needsOf } from "../live/alarms";
import type { Picture } from "../live/picture";
import { displayName } from "../live/urgency";
import { isOld } from "../plan/ellipse";
import type { UnitView } from "../wire";
import * as format from "../format";
import { t } from "../language/translate";
import { Icon } from "./Icon";
import { useGuardedPress } from "./useGuardedPress";

/** Above this number each has a line with room for the name only. */
const MANY = 6;

/** Casualties above the scrolled list, each with cause and position; below all that is pressed there, which the
 * first of them must not move. */
export function Casualties({ unitIds, picture }: { unitIds: readonly string[]; picture: Picture }) {
  if (unitIds.length === 0) return null;
  const many = unitIds.length > MANY ? "many" : "";
  return (
    <ul class={`casualties ${many}`} aria-label={t("card.members_down")}>
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
  const matter = needsOf(unit, picture.alarms.value).map(format.alarmLabel);
  const words = [placeOf(unit, picture.nowMs.value), listed(matter) || format.activityOf(unit)].join(" · ");
  return (
    <li>
      <button
        type="button"
        aria-pressed={selectedUnit.value === unitId}
        title={t("common.hint", { what: t("card.words", { name, words }), action: t("common.show_on_plan") })}
        onClick={steady(() => select(unitId, unit.position?.floor ?? null))}
      >
        <Icon name="alarm" />
        <span class="casualty-name">{name}</span>
        <span class="casualty-words">{words}</span>
      </button>
    </li>
  );
}

/** In short: the card shows the rest. */
function placeOf({ position }: UnitView, nowMs: number): string {
  if (position === null) return t("card.not_located");
  const floor = format.isFloorLikely(position) ? position.floor : null;
  const place = format.floorName(floor);
  return isOld(position, nowMs) ? t("card.old_place", { place }) : place;
}
