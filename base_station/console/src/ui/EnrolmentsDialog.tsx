import { useSignal } from "@preact/signals";
import { attempt, live } from "../sessions";
import * as api from "../api";
import { dateAndTime } from "../format";
import { saveAs } from "../saving";
import { rich, t } from "../language/translate";
import { Columns } from "./Columns";
import { ConfirmButton } from "./ConfirmButton";
import { Dialog } from "./Dialog";
import { QrCode } from "./QrCode";
import { UnitTokens } from "./UnitTokens";
import { useSinglePress } from "./useGuardedPress";
import { fields, useLoaded } from "./useLoaded";
import { Waiting } from "./Waiting";

/** Enrolled units; an administrator enrols others. */
export function EnrolmentsDialog() {
  const [enrolled, again] = useLoaded(api.enrolments);
  const made = useSignal<api.ShownEnrolment | null>(null);
  const single = useSinglePress();
  const enrol = (unitId: string, renew: boolean) => {
    single(() =>
      attempt(api.enrol(unitId, renew)).then((shown) => {
        made.value = shown;
        again(); // also where no answer came: it may have been made
      }),
    );
  };
  return (
    <Dialog title={t("enrolment.title")} wide>
      {made.value === null ? (
        <>
          <EnrolForm enrolled={enrolled.value ?? []} enrol={(unitId) => enrol(unitId, false)} />
          <table class="stacked">
            <Columns names={[t("enrolment.unit"), t("enrolment.until")]} spoken={t("enrolment.renew")} />
            <tbody>
              {(enrolled.value ?? []).map(({ unit_id: unitId, valid_to_ms: validToMs }) => (
                <tr key={unitId}>
                  <th scope="row">{unitId}</th>
                  <td data-label={t("enrolment.until")}>{dateAndTime(validToMs)}</td>
                  <td>
                    <ConfirmButton
                      label={t("enrolment.renew")}
                      about={unitId}
                      question={t("enrolment.renew_question", { unit: unitId })}
                      onConfirm={() => enrol(unitId, true)}
                    />
                  </td>
                </tr>
              ))}
            </tbody>
          </table>
          {enrolled.value === null && <Waiting />}
          {enrolled.value?.length === 0 && <p class="quiet">{t("enrolment.none")}</p>}
          <UnitTokens />
        </>
      ) : (
        <Shown enrolment={made.value} onDone={() => (made.value = null)} />
      )}
    </Dialog>
  );
}

function EnrolForm({
  enrolled,
  enrol,
}: {
  enrolled: readonly api.EnrolledUnit[];
  enrol: (unitId: string) => void;
}) {
  const known = live.value?.picture.unitIds.value ?? [];
  const others = known.filter((unitId) => enrolled.every((one) => one.unit_id !== unitId));
  return (
    <form class="row" onSubmit={(event) => enrol(fields(event)["unit_id"] ?? "")}>
      <label>
        {t("enrolment.unit_id")}
        <input name="unit_id" required maxLength={64} list="not-enrolled" autocomplete="off" />
      </label>
      <datalist id="not-enrolled">
        {others.map((unitId) => (
          <option key={unitId} value={unitId} />
        ))}
      </datalist>
      <button class="primary">{t("enrolment.enrol")}</button>
    </form>
  );
}

/** The private key is in it: it is nowhere else, and gone with this view. */
function Shown({ enrolment, onDone }: { enrolment: api.ShownEnrolment; onDone: () => void }) {
  const { unit_id: unitId, valid_to_ms: validToMs, text } = enrolment;
  const file = `${unitId}.enrolment.toml`;
  return (
    <section class="enrolment" aria-label={t("enrolment.of", { unit: unitId })}>
      <div>
        <p role="status">
          {rich("enrolment.made", {
            unit: <strong>{unitId}</strong>,
            time: dateAndTime(validToMs),
            name: unitId,
          })}
        </p>
        <p>
          <button type="button" class="primary" onClick={() => saveAs(file, new Blob([text]))}>
            {t("enrolment.save")}
          </button>{" "}
          {rich("enrolment.carry", { command: <code>muster edge run --enrolment {file}</code> })}
        </p>
        <p>{rich("enrolment.photo", { command: <code>muster edge enrol PHOTO</code> })}</p>
        <details class="made">
          <summary>{t("enrolment.as_text")}</summary>
          <code>{text}</code>
        </details>
        <ConfirmButton
          label={t("enrolment.done")}
          question={t("enrolment.done_question")}
          yes={t("enrolment.done_yes")}
          onConfirm={onDone}
        />
      </div>
      <QrCode rows={enrolment.qr_rows} label={t("enrolment.qr_code", { unit: unitId })} />
    </section>
  );
}
