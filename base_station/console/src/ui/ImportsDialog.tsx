import { useSignal } from "@preact/signals";
import { bytes, dateAndClock } from "../format";
import {
  fileAddress,
  importedFiles,
  importFile,
  removeImport,
  type ClockOfFile,
  type ImportedFile,
} from "../importedFiles";
import { t } from "../language/translate";
import { codedTexts } from "../live/codedText";
import { importsChanged } from "../plan/imports";
import { attempt, mayAct } from "../sessions";
import { openDialog, withImports } from "../uiState";
import { Columns } from "./Columns";
import { ConfirmButton } from "./ConfirmButton";
import { Dialog } from "./Dialog";
import { useDone } from "./Done";
import { useSinglePress } from "./useGuardedPress";
import { useLoaded } from "./useLoaded";
import { Waiting } from "./Waiting";

/** Imported files of an incident, with the user. */
export function ImportsDialog() {
  const incident = withImports.value;
  const incidentId = incident?.incident_id ?? "";
  const [files, again] = useLoaded(() => importedFiles(incidentId));
  if (incident === null) return null;
  const changed = () => {
    importsChanged.value += 1; // the plan shows it, too
    again();
  };
  return (
    <Dialog title={t("imports.title", { incident: incident.name })} wide>
      {mayAct.value && <AddForm incidentId={incidentId} done={changed} />}
      {files.value === null && <Waiting />}
      {files.value?.length === 0 && <p class="quiet">{t("imports.none")}</p>}
      {files.value !== null && files.value.length > 0 && (
        <Files files={files.value} incidentId={incidentId} done={changed} />
      )}
      <p class="ends">
        <button type="button" onClick={() => openDialog("incidents")}>
          {t("imports.back")}
        </button>
      </p>
    </Dialog>
  );
}

interface FilesProps {
  files: readonly ImportedFile[];
  incidentId: string;
  done: () => void;
}

function Files({ files, incidentId, done }: FilesProps) {
  const names = [t("imports.file"), t("imports.times"), t("imports.brought_in"), "SHA-256"];
  return (
    <table class="stacked">
      <caption>{t("imports.list")}</caption>
      <Columns names={names} {...(mayAct.value ? { spoken: t("imports.take_out") } : {})} />
      <tbody>
        {files.map((file) => (
          <tr key={file.import_id}>
            <th scope="row">
              <FileName file={file} incidentId={incidentId} />
            </th>
            <td data-label={names[1]}>
              {dateAndClock(file.from_ms)}
              {file.until_ms !== file.from_ms && ` – ${dateAndClock(file.until_ms)}`}
              {file.shift_s !== 0 && (
                <span class="quiet"> {t("imports.shifted", { seconds: String(file.shift_s) })}</span>
              )}
            </td>
            <td data-label={names[2]}>
              {file.by}, {dateAndClock(file.t_ms)}
            </td>
            <td data-label={names[3]}>
              <code title={file.sha256}>{file.sha256.slice(0, 16)}…</code>
            </td>
            {mayAct.value && (
              <td>
                <ConfirmButton
                  label={t("imports.take_out")}
                  about={file.file_name}
                  question={t("imports.take_out_question", { file: file.file_name })}
                  yes={t("imports.take_out_yes")}
                  onConfirm={() => void attempt(removeImport(incidentId, file.import_id)).then(done)}
                />
              </td>
            )}
          </tr>
        ))}
      </tbody>
    </table>
  );
}

function FileName({ file, incidentId }: { file: ImportedFile; incidentId: string }) {
  return (
    <>
      {file.is_here ? (
        <a href={fileAddress(incidentId, file.import_id)} download={file.file_name}>
          {file.file_name}
        </a>
      ) : (
        file.file_name
      )}{" "}
      <span class="quiet">
        {bytes(file.size_bytes)}
        {file.is_here ? "" : ` ${t("imports.not_here")}`}
      </span>
      {codedTexts(file.warnings, file.warning_codes).map((warning) => (
        <p key={warning} class="quiet">
          {warning}
        </p>
      ))}
    </>
  );
}

/** One file after the other: an error in one does not stop the next. */
function AddForm({ incidentId, done }: { incidentId: string; done: () => void }) {
  const once = useSinglePress();
  const isBusy = useSignal(false);
  const notice = useDone(t("imports.done"));
  const add = async (files: readonly File[], clock: ClockOfFile) => {
    isBusy.value = true;
    let added = 0;
    for (const file of files) {
      if ((await attempt(importFile(incidentId, file, clock))) !== null) added += 1;
    }
    isBusy.value = false;
    if (added === files.length) notice.say();
    if (added > 0) done();
  };
  return (
    <form
      class="row"
      onInput={notice.unsay}
      onSubmit={(event) => {
        event.preventDefault();
        const form = new FormData(event.currentTarget);
        const files = form.getAll("file").filter((one): one is File => one instanceof File);
        const offset = String(form.get("offset") ?? "");
        const clock = {
          shift_s: Number(form.get("shift") ?? 0),
          utc_offset_h: offset === "" ? null : Number(offset),
        };
        once(() => add(files, clock));
      }}
    >
      <label>
        {t("imports.choose")}
        <input name="file" type="file" multiple required accept=".gpx,.kml,.mcap,image/*" />
      </label>
      <label>
        {t("imports.shift")}
        <input name="shift" type="number" step="any" value="0" required />
      </label>
      <label>
        {t("imports.offset")}
        <input name="offset" type="number" step="0.25" min="-14" max="14" />
      </label>
      <button class="primary" disabled={isBusy.value}>
        {isBusy.value ? t("imports.busy") : t("imports.add")}
      </button>
      {notice.words}
    </form>
  );
}
