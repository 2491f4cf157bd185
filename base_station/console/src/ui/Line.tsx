import { listed } from "../language/measures";
import { isOfAnother } from "../live/alarms";
import type { Picture } from "../live/picture";
import { displayName } from "../live/urgency";
import { isOld, regionAt } from "../plan/ellipse";
import { roomWord } from "../plan/rooms";
import type { UnitView } from "../wire";
import * as format from "../format";
import { t } from "../language/translate";
import { placeWords } from "./Facts";
import { activityIcon, Icon } from "./Icon";
import { ParMark } from "./ParClock";

/** A member in one line: name, alarm or else place, and time of the PAR. */
export function Line({ unit, picture }: { unit: UnitView; picture: Picture }) {
  const name = displayName(unit);
  const words = whatAndWhere(unit, picture);
  return (
    <button type="button" class="card-head" aria-pressed={false} title={t("common.hint", { what: t("card.words", { name, words }), action: t("common.show_on_plan") })}>
      <Icon name={unit.alarms.length > 0 ? "alarm" : activityIcon(unit.status?.activity ?? "")} />
      <span class="name">{name}</span>
      <span class="line-words">{words}</span>
      <ParMark unit={unit} picture={picture} isShort />
    </button>
  );
}

/** The floor, as short as on its button, for what is behind it would be cut; then the alarms or the place. */
function whatAndWhere(unit: UnitView, picture: Picture): string {
  const words = whatOrWhere(unit, picture);
  const floor = unit.position?.floor ?? null;
  const isKnown = unit.position !== null && format.isFloorLikely(unit.position);
  return unit.alarms.length === 0 || floor === null || !isKnown ? words : listed([format.shortFloor(floor), words]);
}

/** The alarms, or else where it is. */
export function whatOrWhere(unit: UnitView, picture: Picture): string {
  const alarms = unit.alarms
    .map((alarmId) => picture.alarms.value.get(alarmId))
    .filter((alarm) => alarm !== undefined)
    .filter((alarm) => !isOfAnother(alarm, unit));
  if (alarms.length > 0) return listed(alarms.map(format.alarmLabel));
  if (!unit.registered) return t("card.unknown_unit");
  if (unit.link !== "live") return format.linkText(unit);
  if (unit.position === null) return t("card.not_located");
  const old = isOld(unit.position, picture.nowMsOf(unit.unit_id)) || picture.silentMs.value > 0;
  const { floor } = unit.position;
  if (floor === null || old || !format.isFloorLikely(unit.position)) {
    return placeWords(unit.position, picture, old);
  }
  const room = roomWord(picture.plan.value, unit.position, regionAt(unit.position, 0));
  return room === "" ? format.floorName(floor) : listed([format.shortFloor(floor), room]);
}
