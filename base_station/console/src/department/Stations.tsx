import { age, duration } from "../format";
import { t } from "../language/translate";
import { problemTexts } from "../live/codedText";
import type { DepartmentView, ReportingStationView } from "./answers";
import { ConsoleLink, Section } from "./Section";

const COLUMNS = ["station", "state", "clock", "people", "waiting", "problems"] as const;
const CLOCK_LIMIT_MS = 5_000; // as the department reports it (live_picture.py)

export function Stations({ view }: { view: DepartmentView }) {
  return (
    <Section
      name="stations"
      title={t("department.stations")}
      columns={COLUMNS.map((key) => t(`department.${key}`))}
      empty={t("department.no_stations")}
      rows={view.stations.map((one) => (
        <tr key={one.station}>
          <td>
            <ConsoleLink text={one.station} url={one.console_url} />
          </td>
          <State station={one} nowMs={view.now_ms} />
          <Clock station={one} />
          <td>{t("department.people_in_incident", { people: one.people, inside: one.in_incident })}</td>
          <td>{one.waiting}</td>
          <td class="quiet">{problemTexts(one).join("; ")}</td>
        </tr>
      ))}
    />
  );
}

function State({ station, nowMs }: { station: ReportingStationView; nowMs: number }) {
  if (station.state === "live") return <td class="good">{t("department.is_live")}</td>;
  if (station.last_ms === null) return <td class="doubtful">{t("department.never")}</td>;
  return <td class="bad">{t("department.away", { age: age(nowMs - station.last_ms) })}</td>;
}

function Clock({ station }: { station: ReportingStationView }) {
  const ahead = station.clock_ahead_ms;
  if (station.last_ms === null) return <td />;
  if (Math.abs(ahead) < CLOCK_LIMIT_MS) return <td class="good">{t("department.clock_right")}</td>;
  const key = ahead > 0 ? "department.clock_ahead" : "department.clock_behind";
  return <td class="bad">{t(key, { time: duration(Math.abs(ahead)) })}</td>;
}
