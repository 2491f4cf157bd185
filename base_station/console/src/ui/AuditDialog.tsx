import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { attempt } from "../sessions";
import * as api from "../api";
import { actionWord, detailWords } from "../audit";
import { clockTime, dateAndTime } from "../words";
import { Columns } from "./Columns";
import { Dialog } from "./Dialog";
import { useLoaded } from "./useLoaded";

const PAGE = 100;

/** Who did what, newest first. */
export function AuditDialog() {
  const entries = useSignal<readonly api.AuditEntry[]>([]);
  const ended = useSignal(false);
  const [people] = useLoaded(api.people);
  const names = new Map((people.value ?? []).map((person) => [person.person_id, person.name]));
  const more = () => {
    const before = entries.peek().at(-1)?.t_ms;
    void attempt(api.audit(before, PAGE)).then((page) => {
      if (page === null) return;
      entries.value = [...entries.peek(), ...page];
      ended.value = page.length < PAGE;
    });
  };
  useEffect(more, []);
  return (
    <Dialog title="Audit log" wide>
      <table class="audit">
        <Columns names={["When", "Who", "Did", "What"]} />
        <tbody>
          {entries.value.map((entry) => (
            <tr key={entry.entry_id}>
              <td>
                {dateAndTime(entry.t_ms).slice(0, 10)} {clockTime(entry.t_ms)}
              </td>
              <td>{entry.by}</td>
              <th scope="row">{actionWord(entry.action)}</th>
              <td class="detail">{detailWords(entry.detail, names)}</td>
            </tr>
          ))}
        </tbody>
      </table>
      {!ended.value && (
        <button type="button" onClick={more}>
          Older entries
        </button>
      )}
    </Dialog>
  );
}
