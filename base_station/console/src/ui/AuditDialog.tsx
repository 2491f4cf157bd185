import * as api from "../api";
import { actionWord, detailWords } from "../audit";
import { dateAndClock } from "../format";
import { t } from "../language/translate";
import { Columns } from "./Columns";
import { Dialog } from "./Dialog";
import { useLoaded } from "./useLoaded";
import { usePages } from "./usePages";
import { Waiting } from "./Waiting";

/** Who did what, newest first. */
export function AuditDialog() {
  const { entries, loaded, older } = usePages(api.audit, (entry) => entry.t_ms);
  const [people] = useLoaded(api.people);
  const names = new Map((people.value ?? []).map((person) => [person.person_id, person.name]));
  return (
    <Dialog title={t("audit.title")} wide>
      <table class="audit stacked">
        <Columns names={[t("audit.when"), t("audit.who"), t("audit.action"), t("audit.what")]} />
        <tbody>
          {entries.value.map((entry) => (
            <tr key={entry.entry_id}>
              <td>
                {dateAndClock(entry.t_ms)}
              </td>
              <td>{entry.by}</td>
              <th scope="row">{actionWord(entry.action)}</th>
              <td class="detail">{detailWords(entry.detail, names)}</td>
            </tr>
          ))}
        </tbody>
      </table>
      {!loaded.value && <Waiting />}
      {older && (
        <button type="button" onClick={older}>
          {t("audit.older")}
        </button>
      )}
    </Dialog>
  );
}
