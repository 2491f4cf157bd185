import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { attempt } from "../sessions";
import * as api from "../api";
import { clockTime, dateAndTime } from "../words";
import { Columns } from "./Columns";
import { Dialog } from "./Dialog";

const PAGE = 100;

/** Who did what, newest first. */
export function AuditDialog() {
  const entries = useSignal<readonly api.AuditEntry[]>([]);
  const ended = useSignal(false);
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
              <th scope="row">{spaced(entry.action)}</th>
              <td class="detail">{said(entry.detail)}</td>
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

/** "AcknowledgeAlarm" as "Acknowledge alarm". */
function spaced(action: string): string {
  const words = action.replaceAll(/(?<=[a-z])(?=[A-Z])/g, " ").toLowerCase();
  return words.charAt(0).toUpperCase() + words.slice(1);
}

/** What was sent with an action, without what was left empty. */
function said(detail: string): string {
  if (!detail.startsWith("{")) return detail;
  const values = Object.entries(JSON.parse(detail) as Record<string, unknown>);
  return values
    .filter(([, value]) => value !== "" && value !== false && value !== 0 && value !== null)
    .map(([name, value]) => `${name.replaceAll("_", " ")}: ${String(value)}`)
    .join(", ");
}
