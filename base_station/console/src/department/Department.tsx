/** The whole page; without a login only the form. */
import { label, t } from "../language/translate";
import { problemTexts } from "../live/codedText";
import { LANGUAGE_CHOICES, languageChoice, type LanguageChoice } from "../language/choices";
import { Login } from "../ui/Login";
import { Alarms } from "./Alarms";
import { Incidents } from "./Incidents";
import { People } from "./People";
import { isLoggedIn, leave, overview, problem, refresh } from "./reports";
import { StationMap } from "./StationMap";
import { Stations } from "./Stations";
import type { DepartmentView } from "./answers";

export function Department() {
  const view = overview.value;
  if (!isLoggedIn.value || view === null) return <Login enter={() => void refresh()} />;
  return (
    <div class="department">
      <header class="header">
        <h1>{t("department.title")}</h1>
        <p role="status">{totals(view)}</p>
        <LanguageChooser />
        <button onClick={() => void leave()}>{t("account.log_out")}</button>
      </header>
      <main>
        <Problems sentences={problemTexts(view)} />
        <Alarms view={view} />
        <Incidents view={view} />
        <StationMap view={view} />
        <People view={view} />
        <Stations view={view} />
      </main>
    </div>
  );
}

function totals(view: DepartmentView): string {
  return t("department.totals", {
    incidents: view.incidents.filter((one) => one.closed_ms === null).length,
    alarms: view.open_alarms,
    people: view.people,
    stations: view.stations.length,
  });
}

function Problems({ sentences }: { sentences: readonly string[] }) {
  const old = problem.value === "" ? [] : [t("department.old", { problem: problem.value })];
  return (
    <div role="alert">
      <ul class="problems">
        {[...old, ...sentences].map((sentence) => (
          <li key={sentence}>{sentence}</li>
        ))}
      </ul>
    </div>
  );
}

function LanguageChooser() {
  return (
    <label class="row">
      <span>{t("display.language")}</span>
      <select
        value={languageChoice.value}
        onChange={(event) => (languageChoice.value = event.currentTarget.value as LanguageChoice)}
      >
        {LANGUAGE_CHOICES.map((one) => (
          <option key={one} value={one}>
            {one === "browser" ? t("display.language_browser") : label("language_name", one)}
          </option>
        ))}
      </select>
    </label>
  );
}
