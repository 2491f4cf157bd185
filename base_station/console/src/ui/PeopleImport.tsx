import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import * as api from "../api";
import { attempt } from "../sessions";
import "../styles/setup.css";
import { Columns } from "./Columns";
import { useSinglePress } from "./useGuardedPress";
import { Waiting } from "./Waiting";

const MOST_FAULTS = 20; // that anybody corrects before the next look
const MOST_ROWS = 100;
const CHANGES = { add: "new", change: "changed", same: "as it is" } as const;

/** People of a file: looked at first, and then all of them taken, or nobody. */
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
    <section class="people-import" aria-label="People of the file">
      <p role="status">
        <strong>{file.name}</strong>: {counted(shown.value.found)}
      </p>
      {faults.length > 0 && (
        <div class="warned" role="alert">
          <p>Nobody is added while lines have faults. Correct them in the file, and choose it again:</p>
          <ul>
            {faults.slice(0, MOST_FAULTS).map(({ line, fault }) => (
              <li key={line}>
                Line {line}: {fault}.
              </li>
            ))}
          </ul>
          {faults.length > MOST_FAULTS && <p>{faults.length - MOST_FAULTS} more lines have faults.</p>}
        </div>
      )}
      <p class="row">
        {faults.length === 0 && news.length > 0 && (
          <button type="button" class="primary" onClick={send}>
            {news.every((one) => one.change === "add") ? "Add" : "Add and change"} {news.length}{" "}
            {news.length === 1 ? "person" : "people"}
          </button>
        )}
        <button type="button" onClick={done}>
          Cancel
        </button>
      </p>
      <table class="stacked">
        <Columns names={["Line", "Name", "Crew", "Role", "Change"]} />
        <tbody>
          {people.slice(0, MOST_ROWS).map((one) => (
            <tr key={one.line}>
              <td data-label="Line">{one.line}</td>
              <th scope="row">{one.name}</th>
              <td data-label="Crew">{one.crew}</td>
              <td data-label="Role">{one.role}</td>
              <td data-label="Change">{CHANGES[one.change]}</td>
            </tr>
          ))}
        </tbody>
      </table>
      {people.length > MOST_ROWS && <p class="quiet">And {people.length - MOST_ROWS} more.</p>}
    </section>
  );
}

/** "12 people: 10 new, 1 changed, 1 as it is". */
function counted({ people }: api.PeopleImport): string {
  const counts = (["add", "change", "same"] as const).map((change) => {
    const count = people.filter((one) => one.change === change).length;
    return count === 0 ? "" : `${count} ${CHANGES[change]}`;
  });
  const all = `${people.length} ${people.length === 1 ? "person" : "people"}`;
  return [all, counts.filter((count) => count !== "").join(", ")].filter((part) => part !== "").join(": ");
}
