import { age, floorName } from "../format";
import { length } from "../language/measures";
import { label, t } from "../language/translate";
import type { DepartmentPersonView, DepartmentView } from "./answers";
import { people, search, skip, station, turnTo, want } from "./reports";
import { SearchField, Section } from "./Section";
import { Turner } from "./Turner";

const COLUMNS = ["who", "crew", "station", "incident", "link", "place", "par", "alarms_open"] as const;
const LINK_CLASS: Readonly<Record<string, string>> = { live: "good", stale: "doubtful", never: "doubtful" };

/** Members in need of help first. */
export function People({ view }: { view: DepartmentView }) {
  const shown = people.value;
  return (
    <Section
      name="people"
      title={t("department.people")}
      columns={COLUMNS.map((key) => t(`department.${key}`))}
      empty={t("department.nobody")}
      rows={(shown?.people ?? []).map((one) => (
        <Row key={`${one.station} ${one.unit_id}`} person={one} view={view} />
      ))}
    >
      <p class="row">
        <SearchField text={t("department.search")} value={search} search={(value) => want({ search: value })} />
        <label class="row">
          {t("department.station")}
          <select value={station} onChange={(event) => want({ station: event.currentTarget.value })}>
            <option value="">{t("department.all")}</option>
            {view.stations.map((one) => (
              <option key={one.station}>{one.station}</option>
            ))}
          </select>
        </label>
        {shown !== null && <Turner first={skip.value} total={shown.total} turn={turnTo} />}
      </p>
    </Section>
  );
}

function Row({ person, view }: { person: DepartmentPersonView; view: DepartmentView }) {
  const incident = view.incidents.find(
    (one) => one.station === person.station && one.incident_id === person.incident_id,
  );
  const name = [person.name, person.label, person.unit_id].find((one) => one !== "");
  return (
    <tr>
      <td class={person.mayday ? "bad" : ""}>
        {name} {person.mayday && label("alarm_label", "mayday")}
      </td>
      <td>{person.crew}</td>
      <td>{person.station}</td>
      <td>{incident?.name ?? ""}</td>
      <td class={LINK_CLASS[person.link] ?? "bad"}>
        {person.link === "station_away" ? t("department.station_away") : label("link", person.link)}
      </td>
      <td>{placeText(person)}</td>
      <td class={person.par_overdue ? "bad" : ""}>
        {person.par_overdue ? t("department.overdue") : parText(person.par)}
      </td>
      <td class={person.alarms > 0 ? "bad" : ""}>{person.alarms}</td>
    </tr>
  );
}

function parText(par: string): string {
  return par === "" ? "" : label("department", `par_${par}`);
}

function placeText(person: DepartmentPersonView): string {
  const { north_m, east_m, radius_m, position_age_s } = person;
  if (north_m === null || east_m === null || position_age_s === null) return t("department.not_located");
  const floor = person.floor === null ? "" : `${floorName(person.floor)}, `;
  const around = radius_m === null ? "" : ` ${t("measure.plus_minus", { value: length(radius_m, 0) })}`;
  return `${floor}${where(person, north_m, east_m)}${around}, ${t("measure.ago", { age: age(1000 * position_age_s) })}`;
}

function where({ lat_deg, lon_deg }: DepartmentPersonView, northM: number, eastM: number): string {
  if (lat_deg !== null && lon_deg !== null) return `${lat_deg.toFixed(5)}, ${lon_deg.toFixed(5)}`;
  const north = t(northM < 0 ? "measure.south" : "measure.north", { length: length(Math.abs(northM), 0) });
  const east = t(eastM < 0 ? "measure.west" : "measure.east", { length: length(Math.abs(eastM), 0) });
  return `${north}, ${east}`;
}
