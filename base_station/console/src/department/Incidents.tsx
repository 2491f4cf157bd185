import { useSignal } from "@preact/signals";
import { clockTime, dateAndTime } from "../format";
import { t } from "../language/translate";
import type { DepartmentIncidentView, DepartmentView, StartedReplay } from "./answers";
import { consoleUrl } from "./consoles";
import { foundIncidents, incidentSearch, incidentSkip, openArchived, searchIncidents } from "./reports";
import { ConsoleLink, SearchField, Section } from "./Section";
import { Turner } from "./Turner";

const COLUMNS = ["incident", "station", "people", "maydays", "alarms_open", "par_overdue", "opened", "show"] as const;

/** Open ones first, then the newest; a search includes all. */
export function Incidents({ view }: { view: DepartmentView }) {
  const found = foundIncidents.value;
  return (
    <Section
      besideMap
      name="incidents"
      title={t("department.incidents")}
      columns={COLUMNS.map((key) => t(`department.${key}`))}
      empty={t("department.no_incidents")}
      rows={(found?.incidents ?? view.incidents).map((one) => (
        <Row key={`${one.station} ${one.incident_id}`} incident={one} view={view} />
      ))}
    >
      <p class="row">
        <SearchField text={t("department.search_incident")} value={incidentSearch} search={searchIncidents} />
        {found !== null && (
          <Turner
            first={incidentSkip.value}
            total={found.total}
            turn={(first) => searchIncidents(incidentSearch.peek(), first)}
          />
        )}
      </p>
    </Section>
  );
}

function Row({ incident, view }: { incident: DepartmentIncidentView; view: DepartmentView }) {
  const isOpen = incident.closed_ms === null;
  return (
    <tr>
      <td>{incident.name}</td>
      <td>
        <ConsoleLink text={incident.station} url={consoleUrl(view, incident.station)} />
      </td>
      <td>{isOpen ? incident.people : ""}</td>
      <Count value={incident.maydays} />
      <Count value={incident.alarms} />
      <Count value={incident.overdue} />
      <td>{times(incident)}</td>
      <td>
        {isOpen ? (
          <ConsoleLink text={t("department.live")} url={consoleUrl(view, incident.station)} />
        ) : (
          view.has_archive && <Archived incident={incident} />
        )}
      </td>
    </tr>
  );
}

function Count({ value }: { value: number }) {
  return <td class={value > 0 ? "bad" : ""}>{value}</td>;
}

function times({ opened_ms, closed_ms }: DepartmentIncidentView): string {
  const opened = dateAndTime(opened_ms);
  return closed_ms === null ? opened : t("department.closed", { opened, closed: clockTime(closed_ms) });
}

/** A replay takes some seconds to start; it has a login of its own. */
function Archived({ incident }: { incident: DepartmentIncidentView }) {
  const started = useSignal<StartedReplay | null>(null);
  const text = useSignal("");
  const busy = useSignal(false);

  async function open() {
    [busy.value, text.value] = [true, t("department.starting")];
    try {
      started.value = await openArchived(incident.station, incident.incident_id);
      text.value = "";
    } catch (error) {
      text.value = (error as Error).message;
    }
    busy.value = false;
  }

  const replay = started.value;
  if (replay !== null) {
    return (
      <>
        <ConsoleLink text={t("department.replay")} url={replayUrl(replay)} />{" "}
        <span class="quiet">{t("department.replay_login", { ...replay })}</span>
      </>
    );
  }
  return (
    <>
      <button disabled={busy} onClick={() => void open()}>
        {t("department.from_archive")}
      </button>{" "}
      <span role="status">{text}</span>
    </>
  );
}

/** Where this page is, at the replay's port. */
function replayUrl({ port }: StartedReplay): string {
  return `${location.protocol}//${location.hostname}:${port}`;
}
