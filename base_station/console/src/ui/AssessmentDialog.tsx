import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { attempt, picture } from "../sessions";
import { assessed, openDialog } from "../view";
import * as api from "../api";
import {
  cells,
  closureOf,
  jumpsOf,
  NOTHING,
  pinWords,
  TERMS,
  tooSure,
  type Assessment,
  type Figures,
  type UnitAssessment,
} from "../assessment";
import { displayName } from "../live/urgency";
import { duration, percent } from "../words";
import { Columns } from "./Columns";
import { Dialog } from "./Dialog";

/** What was promised at the time, and how it stands up to what is known since. */
export function AssessmentDialog() {
  const incident = assessed.value;
  const report = useSignal<Assessment | "asked" | "failed">("asked");
  useEffect(() => {
    if (incident === null) return;
    void attempt(api.assessment(incident.incident_id)).then((answer) => {
      report.value = answer ?? "failed";
    });
  }, [incident]);
  if (incident === null) return null;
  return (
    <Dialog title={`How good were the positions? ${incident.name}`} wide>
      <div aria-live="polite" aria-busy={report.value === "asked"}>
        <Answer report={report.value} />
      </div>
      <p class="ends">
        <button type="button" onClick={() => openDialog("incidents")}>
          All incidents
        </button>
      </p>
    </Dialog>
  );
}

function Answer({ report }: { report: Assessment | "asked" | "failed" }) {
  if (report === "asked") return <p>The station works it out. That may take some seconds …</p>;
  if (report === "failed") return <p class="warned">The station could not work it out.</p>;
  if (report.units.length === 0) return <p>Nobody’s position was shown in this incident.</p>;
  return (
    <>
      <Errors report={report} />
      <dl class="terms">
        {TERMS.map(([term, words]) => (
          <div key={term}>
            <dt>{term}</dt>
            <dd>{words}</dd>
          </div>
        ))}
      </dl>
      <Checks report={report} />
    </>
  );
}

function Errors({ report }: { report: Assessment }) {
  return (
    <table class="assessment">
      <caption>Errors in the terms of ISO/IEC 18305</caption>
      <Columns names={["Person", "Error", "CE50", "CE95", "VE95", "SE95", "Floor right"]} />
      {report.units.map((unit) => (
        <ErrorRows
          key={unit.unit_id}
          name={nameOf(unit, report)}
          figures={unit}
          floor={unit.floor_probability === null ? NOTHING : percent(unit.floor_probability)}
        />
      ))}
      <ErrorRows name="Everybody" figures={report} floor={NOTHING} />
    </table>
  );
}

interface ErrorRowsProps {
  name: string;
  figures: { stated: Figures | null; against_smoothed: Figures | null };
  floor: string;
}

function ErrorRows({ name, figures, floor }: ErrorRowsProps) {
  const { stated, against_smoothed: known } = figures;
  return (
    <tbody>
      <tr>
        <th scope="rowgroup" rowSpan={2}>
          {name}
        </th>
        <th scope="row">as promised then</th>
        <Cells of={stated} />
        <td>{floor}</td>
      </tr>
      <tr>
        <th scope="row">
          by what is known since
          {tooSure(stated, known) && <strong class="warned"> more than promised</strong>}
        </th>
        <Cells of={known} />
        <td />
      </tr>
    </tbody>
  );
}

function Cells({ of }: { of: Figures | null }) {
  return (
    <>
      {cells(of).map((text, column) => (
        <td key={column}>{text}</td>
      ))}
    </>
  );
}

function Checks({ report }: { report: Assessment }) {
  return (
    <table class="assessment">
      <caption>What else tells how good they were</caption>
      <Columns
        names={[
          "Person",
          "Shown for",
          "Walked",
          "Own path missed the beginning by",
          "Jumps as GPS came back",
          "Off from pins",
        ]}
      />
      <tbody>
        {report.units.map((unit) => (
          <tr key={unit.unit_id}>
            <th scope="row">{nameOf(unit, report)}</th>
            <td>{duration(1000 * unit.seconds)}</td>
            <td>{Math.round(unit.walked_m)} m</td>
            <td>{closureOf(unit)}</td>
            <td>{jumpsOf(unit)}</td>
            <td class="detail">{unit.pin_residuals.map(pinWords).join("; ") || NOTHING}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

/** Who wears the unit now is known; who wore it in an incident of the past is not. */
function nameOf({ unit_id }: UnitAssessment, { incident_id }: Assessment): string {
  const shown = picture.value;
  const unit = shown?.incident.value?.incident_id === incident_id ? shown.unit(unit_id)?.value : null;
  return unit?.person ? `${displayName(unit)} (${unit_id})` : unit_id;
}
