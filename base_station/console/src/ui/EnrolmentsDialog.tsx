import { useSignal } from "@preact/signals";
import { attempt, live } from "../sessions";
import * as api from "../api";
import { dateAndTime } from "../format";
import { saveAs } from "../saving";
import { Columns } from "./Columns";
import { ConfirmButton } from "./ConfirmButton";
import { Dialog } from "./Dialog";
import { QrCode } from "./QrCode";
import { UnitTokens } from "./UnitTokens";
import { useSinglePress } from "./useGuardedPress";
import { fields, useLoaded } from "./useLoaded";
import { Waiting } from "./Waiting";

/** Who of the units is enrolled; for an administrator to enrol another. */
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
    <Dialog title="Enrolments" wide>
      {made.value === null ? (
        <>
          <EnrolForm enrolled={enrolled.value ?? []} enrol={(unitId) => enrol(unitId, false)} />
          <table class="stacked">
            <Columns names={["Unit", "Enrolled until"]} spoken="Renew" />
            <tbody>
              {(enrolled.value ?? []).map(({ unit_id: unitId, valid_to_ms: validToMs }) => (
                <tr key={unitId}>
                  <th scope="row">{unitId}</th>
                  <td data-label="Enrolled until">{dateAndTime(validToMs)}</td>
                  <td>
                    <ConfirmButton
                      label="Renew"
                      about={unitId}
                      question={`${unitId} gets a new certificate, and the old one works until it ends. A unit that is lost is revoked instead.`}
                      onConfirm={() => enrol(unitId, true)}
                    />
                  </td>
                </tr>
              ))}
            </tbody>
          </table>
          {enrolled.value === null && <Waiting />}
          {enrolled.value?.length === 0 && <p class="quiet">No unit is enrolled yet.</p>}
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
        Unit id
        <input name="unit_id" required maxLength={64} list="not-enrolled" autocomplete="off" />
      </label>
      <datalist id="not-enrolled">
        {others.map((unitId) => (
          <option key={unitId} value={unitId} />
        ))}
      </datalist>
      <button class="primary">Enrol unit</button>
    </form>
  );
}

/** The private key is in it: it is nowhere else, and gone with this view. */
function Shown({ enrolment, onDone }: { enrolment: api.ShownEnrolment; onDone: () => void }) {
  const { unit_id: unitId, valid_to_ms: validToMs, text } = enrolment;
  const file = `${unitId}.enrolment.toml`;
  return (
    <section class="enrolment" aria-label={`Enrolment of ${unitId}`}>
      <div>
        <p role="status">
          Enrolment of <strong>{unitId}</strong>, valid until {dateAndTime(validToMs)}. It is shown this once, and
          whoever has it is {unitId}: photograph it for that unit alone, and keep no copy.
        </p>
        <p>
          <button type="button" class="primary" onClick={() => saveAs(file, new Blob([text]))}>
            Save as file
          </button>{" "}
          Carry it to the unit and delete it here. There: <code>muster edge run --enrolment {file}</code>
        </p>
        <p>
          With a photo of the code, on the unit: <code>muster edge enrol PHOTO</code>
        </p>
        <details class="made">
          <summary>As text, to be saved as a file on the unit</summary>
          <code>{text}</code>
        </details>
        <ConfirmButton
          label="Done"
          question="It cannot be shown again. Does the unit have it?"
          yes="Yes, it has it"
          onConfirm={onDone}
        />
      </div>
      <QrCode rows={enrolment.qr_rows} label={`QR code of the enrolment of ${unitId}`} />
    </section>
  );
}
