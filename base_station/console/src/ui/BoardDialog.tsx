import { picture as shown } from "../sessions";
import { alarmLabel, dateAndTime, floorName, minutes } from "../format";
import { onScene, partOf } from "../live/headcount";
import { compareNames, listed } from "../language/measures";
import { needsOf } from "../live/alarms";
import type { Picture } from "../live/picture";
import { displayName } from "../live/urgency";
import type { UnitView } from "../wire";
import { label, t } from "../language/translate";
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
    <Dialog title={t("board.title")} wide>
      <p class="row not-printed">
        <button type="button" class="primary" onClick={() => print()}>
          {t("board.print")}
        </button>
      </p>
      <p>
        {t("board.summary", {
          incident: picture.incident.value?.name ?? t("board.no_incident"),
          count: members.length,
          time: dateAndTime(nowMs),
        })}
        {picture.link.value.kind !== "up" && `. ${t("board.not_current")}`}
      </p>
      <table class="board">
        <Columns names={[
            t("board.crew"),
            t("common.name"),
            t("board.unit"),
            t("board.state"),
            t("board.floor"),
            t("board.inside_for"),
          ]} />
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
  return listed([label("headcount", partOf(unit)), ...needs]);
}

function floorOf({ position }: UnitView): string {
  return position === null || position.floor === null ? t("board.floor_unknown") : floorName(position.floor);
}

function byCrew(a: UnitView, b: UnitView): number {
  const [one, other] = [a.person?.crew ?? "", b.person?.crew ?? ""];
  return compareNames(one, other) || compareNames(displayName(a), displayName(b));
}
