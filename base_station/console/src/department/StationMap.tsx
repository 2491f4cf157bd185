/** Map of stations whose site has a geodetic anchor, with people in need of help. */
import { far, length } from "../language/measures";
import { t } from "../language/translate";
import type { DepartmentView, ReportingStationView } from "./answers";
import { mapOf, type Anchor } from "./mapScale";
import { station, want } from "./reports";

const NAMES_MAX = 40; // beyond that only those with alarms have their name on the map
const KILOMETRE_M = 1000;

interface Marked extends Anchor {
  station: string;
  state: ReportingStationView["state"];
  alarms: number; // of people in open incidents
}

export function StationMap({ view }: { view: DepartmentView }) {
  const marks = marked(view);
  if (marks.length === 0) return null;
  const { placed, bar, barM } = mapOf(marks);
  return (
    <section class="map" aria-labelledby="map">
      <h2 id="map">{t("department.map")}</h2>
      <div class="station-map">
        {placed.map(({ what, left, top }) => (
          <button
            key={what.station}
            class={what.alarms > 0 ? "bad" : `is-${what.state}`}
            style={{ left: `${100 * left}%`, top: `${100 * top}%` }}
            aria-pressed={station.value === what.station}
            aria-label={markText(what)}
            title={markText(what)}
            onClick={() => want({ station: station.value === what.station ? "" : what.station })}
          >
            <span class="dot" aria-hidden="true" />
            {(what.alarms > 0 || placed.length <= NAMES_MAX) && <span aria-hidden="true">{what.station}</span>}
          </button>
        ))}
        <p class="bar" style={{ width: `${100 * bar}%` }}>
          {barM >= KILOMETRE_M ? far(barM) : length(barM, 0)}
        </p>
      </div>
      <p class="quiet">{t("department.map_hint")}</p>
    </section>
  );
}

function markText({ station: name, state, alarms }: Marked): string {
  const words = state === "live" ? t("department.is_live") : t("department.station_away");
  return t("department.mark", { station: name, state: words, alarms });
}

function marked(view: DepartmentView): Marked[] {
  return view.stations.flatMap(({ station: name, state, lat_deg, lon_deg }) => {
    if (lat_deg === null || lon_deg === null) return [];
    const there = view.incidents.filter((one) => one.station === name && one.closed_ms === null);
    const alarms = there.reduce((sum, one) => sum + Math.max(one.alarms, one.maydays), 0);
    return [{ station: name, state, lat_deg, lon_deg, alarms }];
  });
}
