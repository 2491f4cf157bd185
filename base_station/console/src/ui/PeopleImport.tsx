import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import * as api from "../api";
import { attempt } from "../sessions";
import "../styles/setup.css";
import { listed } from "../language/measures";
import { rich, t } from "../language/translate";
import { codedText } from "../live/codedText";
import { Columns } from "./Columns";
import { useSinglePress } from "./useGuardedPress";
import { Waiting } from "./Waiting";

const MOST_FAULTS = 20; // that anybody corrects before the next look
const MOST_ROWS = 100;

/** Import of people from a file: a preview first, and then all of them or none. */
export function PeopleImport({ file, done }: { file: File; done: () => void }) {
  const shown = useSignal<{ file: File; found: api.PeopleImport } | null>(null);
  const single = useSinglePress();
  useEffect(() => {
    let isWanted = true;
    void attempt(api.importPeople(file, true)).then((found) => {
      if (!isWanted) return;
      if (found === null) done();
      else shown.value = { file, found };
    });
    return () => {
      isWanted = false;
    };
  }, [file]);
  if (shown.value?.file !== file) return <Waiting />;
  const { people, faulty_lines: faults } = shown.value.found;
  const news = people.filter((one) => one.change !== "same");
  const send = () => single(() => attempt(api.importPeople(file, false)).then((sent) => sent && done()));
  return (
    <section class="people-import" aria-label={t("people_import.title")}>
      <p role="status">
        {rich("people_import.counts", { file: <strong>{file.name}</strong>, counts: counted(shown.value.found) })}
      </p>
      {faults.length > 0 && (
        <div class="warned" role="alert">
          <p>{t("people_import.faulty")}</p>
          <ul>
            {faults.slice(0, MOST_FAULTS).map(({ line, fault, fault_code: code }) => (
              <li key={line}>{t("people_import.fault", { line, fault: codedText(code ?? undefined, fault) })}</li>
            ))}
          </ul>
          {faults.length > MOST_FAULTS && <p>{t("people_import.more_faults", { count: faults.length - MOST_FAULTS })}</p>}
        </div>
      )}
      <p class="row">
        {faults.length === 0 && news.length > 0 && (
          <button type="button" class="primary" onClick={send}>
            {t(news.every((one) => one.change === "add") ? "people_import.send_add" : "people_import.send_change", {
              count: news.length,
            })}
          </button>
        )}
        <button type="button" onClick={done}>
          {t("menu.cancel")}
        </button>
      </p>
      <table class="stacked">
        <Columns names={[t("people_import.line"), t("person.name"), t("person.crew"), t("person.role"), t("person.change")]} />
        <tbody>
          {people.slice(0, MOST_ROWS).map((one) => (
            <tr key={one.line}>
              <td data-label={t("people_import.line")}>{one.line}</td>
              <th scope="row">{one.name}</th>
              <td data-label={t("person.crew")}>{one.crew}</td>
              <td data-label={t("person.role")}>{one.role}</td>
              <td data-label={t("person.change")}>{t(`people_import.${one.change}`)}</td>
            </tr>
          ))}
        </tbody>
      </table>
      {people.length > MOST_ROWS && <p class="quiet">{t("people_import.more", { count: people.length - MOST_ROWS })}</p>}
    </section>
  );
}

/** "12 people: 10 new, 1 changed, 1 unchanged". */
function counted({ people }: api.PeopleImport): string {
  const counts = (["add", "change", "same"] as const).map((change) => {
    const count = people.filter((one) => one.change === change).length;
    return count === 0 ? "" : t("people_import.count_of", { count, change: t(`people_import.${change}`) });
  });
  const all = t("people_import.people", { count: people.length });
  const known = counts.filter((count) => count !== "");
  return known.length === 0 ? all : t("people_import.all", { all, counts: listed(known) });
}
