import { useSignal } from "@preact/signals";
import * as api from "../api";
import { zone } from "../format";
import { t } from "../language/translate";
import { live, liveIsPast, mayAct, user } from "../sessions";
import { Columns } from "./Columns";
import { Dialog } from "./Dialog";
import { IncidentRow } from "./IncidentRow";
import { OpenIncidentForm } from "./OpenIncidentForm";
import { OpenReplays } from "./OpenReplays";
import { RunningIncident } from "./RunningIncident";
import { UnopenedDispatches } from "./UnopenedDispatches";
import { fields, useLoaded } from "./useLoaded";
import { usePages } from "./usePages";
import { Waiting } from "./Waiting";

const COLUMNS = [
  "incident.incident",
  "incident.opened",
  "incident.duration",
  "incident.replay",
  "incident.tracks",
  "incident.report",
  "incident.positions",
] as const;

export function IncidentsDialog() {
  const sought = useSignal(""); // words
  const { entries, loaded, older, again } = usePages(
    (untilMs) => api.incidents(untilMs, sought.peek()),
    (one) => one.opened_ms,
  );
  const [formats] = useLoaded(api.exportFormats);
  const open = live.value?.picture.incident.value ?? null;
  const forgets = user.value?.role === "administrator" && !liveIsPast.value;
  const running = open !== null && open.closed_ms === null ? open : null;
  const columns = [...COLUMNS.map((key) => t(key)), ...(forgets ? [t("incident.personal_data")] : [])];
  return (
    <Dialog title={t("incident.title")} wide>
      {mayAct.value && running === null && <OpenIncidentForm done={again} />}
      {mayAct.value && running !== null && <RunningIncident running={running} done={again} />}
      {mayAct.value && <UnopenedDispatches />}
      <p class="quiet">{t("incident.times_zone", { zone: zone(Date.now()) })}</p>
      <SearchForm
        search={(text) => {
          sought.value = text;
          again();
        }}
      />
      <table class="stacked">
        <caption>
          {sought.value === "" ? t("incident.past") : t("incident.found", { words: sought.value })}
        </caption>
        <Columns names={columns} />
        <tbody>
          {entries.value.map((incident) => (
            <IncidentRow
              key={incident.incident_id}
              incident={incident}
              all={entries.value}
              formats={formats.value ?? []}
              forgets={forgets}
              done={again}
            />
          ))}
        </tbody>
      </table>
      {!loaded.value && <Waiting />}
      {loaded.value && entries.value.length === 0 && (
        <p class="quiet">{t(sought.value === "" ? "incident.none" : "incident.none_found")}</p>
      )}
      {older && (
        <button type="button" onClick={older}>
          {t("incident.older")}
        </button>
      )}
      <OpenReplays incidents={entries.value} />
    </Dialog>
  );
}

/** Finds incidents by words; none: all of them. */
function SearchForm({ search }: { search: (text: string) => void }) {
  return (
    <form class="row" role="search" onSubmit={(event) => search(fields(event)["text"] ?? "")}>
      <label>
        {t("incident.search_label")}
        <input type="search" name="text" maxLength={200} />
      </label>
      <button>{t("incident.search")}</button>
    </form>
  );
}
