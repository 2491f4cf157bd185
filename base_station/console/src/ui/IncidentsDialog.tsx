import { useSignal } from "@preact/signals";
import { attempt, live, liveIsPast, mayAct, user, watchReplay } from "../sessions";
import * as api from "../api";
import { unfinished } from "../live/closing";
import type { Picture } from "../live/picture";
import { summary } from "../live/dispatch";
import { KINDS, type TrailKind } from "../plan/pastTrails";
import { assess, openDispatch, openImports, openRehearsal } from "../uiState";
import type { IncidentView } from "../wire";
import { dateAndTime, minutes, zone } from "../format";
import { saveAs } from "../saving";
import { listed } from "../language/measures";
import { rich, t } from "../language/translate";
import { Columns } from "./Columns";
import { AssignForm } from "./AssignForm";
import { ConfirmButton } from "./ConfirmButton";
import { Dialog } from "./Dialog";
import { useDone } from "./Done";
import { EraseForm } from "./EraseForm";
import { showIncident } from "./showIncident";
import { TimesFields, timesOf } from "./TimesFields";
import { useSinglePress } from "./useGuardedPress";
import { OpenReplays } from "./OpenReplays";
import { useChosen } from "./useChosen";
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
      {mayAct.value && running === null && <OpenForm done={again} />}
      {mayAct.value && running !== null && (
        <p class="row said">
          <span>{rich("incident.is_open", { incident: <strong>{running.name}</strong> })}</span>
          <CloseButton incident={running} done={again} />
        </p>
      )}
      {mayAct.value && running !== null && <TimesForm key={running.incident_id} incident={running} />}
      {mayAct.value && running !== null && live.value !== null && (
        <SeveralIncidents running={running} picture={live.value.picture} done={again} />
      )}
      {mayAct.value && <Dispatches />}
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
            <tr key={incident.incident_id}>
              <th scope="row">
                {incident.name}
                {incident.dispatch_number !== "" && (
                  <span class="quiet"> {t("dispatch.title", { number: incident.dispatch_number })}</span>
                )}
              </th>
              <td data-label={t("incident.opened")}>{dateAndTime(incident.opened_ms)}</td>
              <td data-label={t("incident.duration")}>
                {incident.closed_ms === null
                  ? t("incident.still_open")
                  : minutes(incident.closed_ms - incident.opened_ms)}
                {incident.archived_ms !== null && (
                  <span class="quiet">
                    {" "}
                    {t("incident.archived", { time: dateAndTime(incident.archived_ms) })}
                  </span>
                )}
                {incident.erased_at_ms !== null && (
                  <span class="quiet">
                    {" "}
                    {t("incident.erased_at", { time: dateAndTime(incident.erased_at_ms) })}
                  </span>
                )}
              </td>
              <td>
                <button
                  type="button"
                  aria-label={t("incident.replay_of", { incident: incident.name })}
                  onClick={() => void watchReplay(incident)}
                >
                  {t("incident.replay")}
                </button>{" "}
                <button
                  type="button"
                  aria-label={t("imports.open_about", { incident: incident.name })}
                  onClick={() => openImports(incident)}
                >
                  {t("imports.open")}
                </button>
              </td>
              <td>
                <Downloads incident={incident} formats={formats.value ?? []} />
              </td>
              <td data-label={t("incident.report")}>
                <Report incident={incident} />
              </td>
              <td>
                <button
                  type="button"
                  aria-label={t("assessment.title", { incident: incident.name })}
                  onClick={() => assess(incident)}
                >
                  {t("incident.accuracy")}
                </button>{" "}
                {incident.closed_ms !== null && (
                  <button
                    type="button"
                    aria-label={t("incident.rehearse_of", { incident: incident.name })}
                    onClick={() => openRehearsal(incident)}
                  >
                    {t("incident.rehearse")}
                  </button>
                )}
              </td>
              {forgets && (
                <td>
                  {incident.closed_ms !== null && (
                    <EraseForm
                      name={incident.name}
                      warning={eraseWarning(incident, entries.value)}
                      subjectId={incident.incident_id}
                      forget={(name) => api.forgetIncident(incident.incident_id, name)}
                      done={again}
                    />
                  )}
                </td>
              )}
            </tr>
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

/** Names the incidents of the list that were open while this one was. */
function eraseWarning(incident: api.Incident, all: readonly api.Incident[]): string {
  const endMs = (one: api.Incident) => one.closed_ms ?? Infinity;
  const beside = all.filter(
    (one) =>
      one.incident_id !== incident.incident_id &&
      one.opened_ms < endMs(incident) &&
      incident.opened_ms < endMs(one),
  );
  if (beside.length === 0) return t("incident.erase_warning");
  const others = listed(beside.map((one) => one.name));
  return t("incident.erase_warning_beside", { others });
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

/** From which no incident was opened: offered, dismissed, or over. */
function Dispatches() {
  const dispatches = live.value?.picture.dispatches.value ?? [];
  if (dispatches.length === 0) return null;
  return (
    <section aria-label={t("incident.dispatches")}>
      <h3>{t("incident.from_dispatch")}</h3>
      <ul class="dispatches">
        {dispatches.toReversed().map((one) => (
          <li class="row" key={one.number}>
            <span>
              <strong>{one.number}</strong> {summary(one)}
              {one.has_ended && <span class="quiet"> {t("incident.ended")}</span>}
              {one.is_dismissed && <span class="quiet"> {t("incident.dismissed")}</span>}
            </span>
            <button
              type="button"
              aria-label={t("incident.look_at", { number: one.number })}
              onClick={() => openDispatch(one.number)}
            >
              {t("incident.look")}
            </button>
          </li>
        ))}
      </ul>
    </section>
  );
}

/** With open alarms or people inside, only by naming them. */
function CloseButton({ incident, done }: { incident: IncidentView; done: () => void }) {
  const picture = live.value?.picture;
  if (picture === undefined) return null;
  void picture.unitsChanged.value;
  const members = picture.allUnits();
  const alarms = [...picture.alarms.value.values()].filter(({ unit_id }) => picture.isShown(unit_id));
  const { words, ...despite } = unfinished(members, alarms);
  return (
    <ConfirmButton
      label={t("incident.close")}
      question={
        words === "" ? t("incident.close_question") : t("incident.close_over", { unfinished: words })
      }
      onConfirm={() => void attempt(api.closeIncident(incident.incident_id, despite)).then(done)}
    />
  );
}

/** Crews for the incident that is shown, and another incident beside it. */
function SeveralIncidents({ running, picture, done }: SeveralProps) {
  const isAsked = useSignal(false);
  const several = picture.choices.value.length > 0;
  const opened = (incident: api.Incident | null) => {
    if (incident === null) return;
    isAsked.value = false;
    showIncident(picture, incident.incident_id);
    done();
  };
  return (
    <>
      {several && <AssignForm key={running.incident_id} incident={running} picture={picture} />}
      <p class="row">
        <button
          type="button"
          aria-expanded={isAsked.value}
          onClick={() => (isAsked.value = !isAsked.value)}
        >
          {t("incident.open_another")}
        </button>
      </p>
      {isAsked.value && (
        <>
          <p>{rich("incident.goes_on", { incident: <strong>{running.name}</strong> })}</p>
          <OpenForm beside done={opened} />
        </>
      )}
    </>
  );
}

interface SeveralProps {
  running: IncidentView;
  picture: Picture;
  done: () => void;
}

interface OpenProps {
  done: (opened: api.Incident | null) => void;
  beside?: boolean; // another one that is open
}

function OpenForm({ done, beside = false }: OpenProps) {
  const [usual] = useLoaded(api.usualTimes);
  const once = useSinglePress();
  return (
    <form
      class="row"
      onSubmit={(event) => {
        const given = fields(event);
        const times = usual.value === null ? {} : timesOf(given);
        const open = beside ? api.openBeside : api.openIncident;
        once(() => attempt(open(given["name"] ?? "", times)).then(done));
      }}
    >
      <label>
        {t("dispatch.incident_name")}
        <input name="name" required maxLength={80} autofocus />
      </label>
      <TimesFields key={usual.value === null ? "asked" : "known"} times={usual.value} />
      <button class="primary">{t(beside ? "incident.open_beside" : "dispatch.open_incident")}</button>
    </form>
  );
}

/** Change of the times during an incident. */
function TimesForm({ incident }: { incident: IncidentView }) {
  const done = useDone(t("incident.times_changed"));
  return (
    <form
      class="row"
      onInput={done.unsay}
      onSubmit={(event) => {
        const changed = api.setTimes(incident.incident_id, timesOf(fields(event)));
        void attempt(changed.then(done.say));
      }}
    >
      <TimesFields times={incident} />
      <button>{t("incident.change_times")}</button>
      {done.words}
    </form>
  );
}

/** With a plain link the browser would leave the console for a refusal. */
async function save(content: Promise<Blob>, name: string): Promise<void> {
  saveAs(name, await content);
}

interface DownloadsProps {
  incident: api.Incident;
  formats: readonly api.ExportFormat[];
}

const WHOLE = "mcap";
const WITH_RADIO = "mcap with radio";

/** Export of an incident for other programs: its tracks, or all data. */
function Downloads({ incident, formats }: DownloadsProps) {
  const writing = useSignal(false);
  const files = KINDS.flatMap((kind) => formats.map((format) => ({ kind, format })));
  const write = async (content: Promise<Blob>, ending: string) => {
    writing.value = true;
    await attempt(save(content, `${incident.incident_id}${ending}`));
    writing.value = false;
  };
  const chosen = useChosen("", async (key) => {
    if (key === WHOLE || key === WITH_RADIO) {
      return write(api.wholeIncident(incident.incident_id, key === WITH_RADIO), `.${WHOLE}`);
    }
    const file = files.find((one) => keyOf(one.kind, one.format) === key);
    if (file === undefined) return;
    const which = file.kind === "fused" ? "" : `-${file.kind}`; // as the station names it
    const content = api.exported(incident.incident_id, file.format.name, file.kind);
    await write(content, `${which}.${file.format.suffix}`);
  });
  return (
    <select
      aria-label={t("incident.save_of", { incident: incident.name })}
      disabled={writing.value}
      {...chosen}
    >
      <option value="">{t(writing.value ? "incident.writing" : "incident.save_as")}</option>
      {KINDS.map((kind) => (
        <optgroup key={kind} label={t(`trail.${kind}`)}>
          {formats.map((format) => (
            <option key={format.name} value={keyOf(kind, format)}>
              {format.name}
            </option>
          ))}
        </optgroup>
      ))}
      <optgroup label={t("incident.whole")}>
        <option value={WHOLE}>{WHOLE}</option>
        {user.value?.role !== "viewer" && (
          <option value={WITH_RADIO}>{t("incident.with_radio", { format: WHOLE })}</option>
        )}
      </optgroup>
    </select>
  );
}

/** Report of the incident as a document. */
function Report({ incident }: { incident: api.Incident }) {
  const writing = useSignal(false);
  const write = async (suffix: "html" | "pdf") => {
    writing.value = true;
    const content = api.report(incident.incident_id, suffix);
    await attempt(save(content, `${incident.incident_id}-report.${suffix}`));
    writing.value = false;
  };
  return (
    <span class="row">
      {(["html", "pdf"] as const).map((suffix) => (
        <button
          key={suffix}
          type="button"
          disabled={writing.value}
          aria-label={t("incident.report_of", { incident: incident.name, format: suffix.toUpperCase() })}
          onClick={() => void write(suffix)}
        >
          {suffix.toUpperCase()}
        </button>
      ))}
    </span>
  );
}

function keyOf(kind: TrailKind, format: api.ExportFormat): string {
  return `${format.name} ${kind}`;
}
