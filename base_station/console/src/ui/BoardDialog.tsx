import { picture as shown } from "../sessions";
import { alarmLabel, dateAndTime, floorName, minutes } from "../format";
import { onScene, PART_WORDS, partOf } from "../live/headcount";
import { needsOf } from "../live/alarms";
import type { Picture } from "../live/picture";
import { displayName } from "../live/urgency";
import type { UnitView } from "../wire";
import { Columns } from "./Columns";
import { Dialog } from "./Dialog";

/** The board of members as it is now, to be printed: crew by crew, black on white. */
export function BoardDialog() {
  const picture = shown.value;
  if (picture === null) return null;
  void picture.unitsChanged.value;
  const nowMs = picture.nowMs.value;
  const members = [...onScene(picture.allUnits())].sort(byCrew);
  return (
    <Dialog title="Board" wide>
      <p class="row not-printed">
        <button type="button" class="primary" onClick={() => print()}>
          Print
        </button>
      </p>
      <p>
        {picture.incident.value?.name ?? "No incident open"}, {members.length} on scene, {dateAndTime(nowMs)}
        {picture.link.value.kind !== "up" && ". Not current: the station is not connected."}
      </p>
      <table class="board">
        <Columns names={["Crew", "Name", "Unit", "State", "Floor", "Inside for"]} />
        <tbody>
          {members.map((unit) => (
            <tr key={unit.unit_id}>
              <td>{unit.person?.crew ?? ""}</td>
              <th scope="row">{displayName(unit)}</th>
              <td>{unit.unit_id}</td>
              <td>{stateOf(unit, picture)}</td>
              <td>{floorOf(unit)}</td>
              <td>{unit.inside_since_ms === null ? "" : minutes(nowMs - unit.inside_since_ms)}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </Dialog>
  );
}

function stateOf(unit: UnitView, picture: Picture): string {
  const needs = needsOf(unit, picture.alarms.value).map(alarmLabel);
  return [PART_WORDS[partOf(unit)], ...needs].join(", ");
}

function floorOf({ position }: UnitView): string {
  return position === null || position.floor === null ? "not known" : floorName(position.floor);
}

function byCrew(a: UnitView, b: UnitView): number {
  const [one, other] = [a.person?.crew ?? "", b.person?.crew ?? ""];
  return one.localeCompare(other) || displayName(a).localeCompare(displayName(b));
}
