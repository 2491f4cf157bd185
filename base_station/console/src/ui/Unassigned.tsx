import type { ReadonlySignal } from "@preact/signals";
import type { Picture } from "../live/picture";
import { arrange, isCasualty } from "../live/urgency";
import { t } from "../language/translate";
import { PeopleGroups } from "./PeopleGroups";

interface Props {
  picture: Picture;
  second: ReadonlySignal<number>; // with which it is drawn anew
  brief: boolean;
}

/** Units of no open incident: they are on no plan and in no headcount, but are listed. */
export function Unassigned({ picture, second, brief }: Props) {
  void [second.value, picture.unitsChanged.value];
  const units = picture.unassignedUnits();
  if (units.length === 0) return null;
  const places = arrange([], units, picture.alarms.value, picture.nowMs.peek(), false);
  const down = places.filter(isCasualty).length;
  return <PeopleGroups groups={[{ crew: t("wall.unassigned"), places, down }]} brief={brief} picture={picture} />;
}
