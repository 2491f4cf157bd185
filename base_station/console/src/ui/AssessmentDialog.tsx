import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { attempt } from "../sessions";
import { assessed, openDialog } from "../uiState";
import * as api from "../api";
import {
  cells,
  closureOf,
  jumpsOf,
  lightParts,
  NOTHING,
  pinWords,
  TERMS,
  tooSure,
  wearerOf,
  type Assessment,
  type Figures,
  type TrustSeconds,
} from "../assessment";
import { duration, percent } from "../format";
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

const LATE =
  "A unit’s journal or a pin has told more of this incident since. The station works it out " +
  "again once nothing more has come for half a minute: open this again then.";

function Answer({ report }: { report: Assessment | "asked" | "failed" }) {
  if (report === "asked") return <p>The station works it out. That may take some seconds …</p>;
  if (report === "failed") return <p class="warned">The station could not work it out.</p>;
  if (report.units.length === 0) return <p>Nobody’s position was shown in this incident.</p>;
  return (
    <>
      {!report.is_newest && <p class="warned">{LATE}</p>}
      {report.flaws.map((flaw) => (
        <p key={flaw} class="warned">
          {flaw}
        </p>
      ))}
      <Lights report={report} />
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

const FIGURES = ["CE50", "CE95", "VE95", "SE95"];
const FLOOR = "Floor right";

function Errors({ report }: { report: Assessment }) {
  return (
    <table class="assessment stacked">
      <caption>Errors in the terms of ISO/IEC 18305</caption>
      <Columns names={["Person", "Error", ...FIGURES, FLOOR]} />
      {report.units.map((unit) => (
        <ErrorRows
          key={unit.unit_id}
          name={wearerOf(unit)}
          figures={unit}
          floors={[unit.floor_probability, unit.floor_right]}
        />
      ))}
      <ErrorRows name="Everybody" figures={report} floors={[null, null]} />
    </table>
  );
}

interface ErrorRowsProps {
  name: string;
  figures: { stated: Figures | null; against_smoothed: Figures | null };
  floors: [number | null, number | null]; // promised, and as is known since
}

function ErrorRows({ name, figures, floors }: ErrorRowsProps) {
  const { stated, against_smoothed: known } = figures;
  return (
    <tbody>
      <tr>
        <th scope="rowgroup" rowSpan={2}>
          {name}
        </th>
        <th scope="row">as promised then</th>
        <Cells of={stated} />
        <td data-label={FLOOR}>{share(floors[0])}</td>
      </tr>
      <tr>
        <th scope="row">
          by what is known since
          {tooSure(stated, known) && <strong class="warned"> more than promised</strong>}
        </th>
        <Cells of={known} />
        <td data-label={FLOOR}>{share(floors[1])}</td>
      </tr>
    </tbody>
  );
}

function share(part: number | null): string {
  return part === null ? NOTHING : percent(part);
}

/** How far the station itself trusted each place, as it said at the time. */
function Lights({ report }: { report: Assessment }) {
  return (
    <table class="assessment stacked">
      <caption>
        How far the places could be trusted: amber is “Place uncertain” on the card, red “Do not trust this
        place”
      </caption>
      <Columns names={["Person", "Green, amber, red", "For how long", "Why not green"]} />
      <tbody>
        {report.units.map((unit) => (
          <tr key={unit.unit_id}>
            <th scope="row">{wearerOf(unit)}</th>
            <td>
              <LightBar trust={unit.trust} />
            </td>
            <td>{lightWords(unit.trust)}</td>
            <td class="detail" data-label="Why not green">
              {unit.trust.causes.length === 0 && NOTHING}
              {unit.trust.causes.map(([cause, seconds]) => (
                <div key={cause}>
                  {cause} {unbroken(seconds)}
                </div>
              ))}
            </td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

function LightBar({ trust }: { trust: TrustSeconds }) {
  const parts = lightParts(trust);
  if (parts === null) return <>{NOTHING}</>;
  return (
    <span class="light-bar" aria-hidden="true">
      {(["green", "amber", "red"] as const).map((level) => (
        <span key={level} class={level} style={{ flexGrow: parts[level] }} />
      ))}
    </span>
  );
}

function lightWords(trust: TrustSeconds): string {
  const said = [
    [trust.green_s, "green"],
    [trust.amber_s, "amber"],
    [trust.red_s, "red"],
  ] as const;
  const words = said.filter(([seconds]) => seconds > 0);
  return words.map(([seconds, level]) => `${unbroken(seconds)} ${level}`).join(", ") || NOTHING;
}

/** So long, on one line. */
function unbroken(seconds: number): string {
  return duration(1000 * seconds).replaceAll(" ", "\u00a0");
}

function Cells({ of }: { of: Figures | null }) {
  return (
    <>
      {cells(of).map((text, column) => (
        <td key={column} data-label={FIGURES[column]}>
          {text}
        </td>
      ))}
    </>
  );
}

const CHECKS = {
  seconds: "Shown for",
  walked: "Walked",
  closure: "Own path missed the beginning by",
  jumps: "Jumps as GPS came back",
  pins: "Off from pins",
  notUsed: "GPS and beacons not used",
};

function Checks({ report }: { report: Assessment }) {
  return (
    <table class="assessment stacked">
      <caption>What else tells how good they were</caption>
      <Columns names={["Person", ...Object.values(CHECKS)]} />
      <tbody>
        {report.units.map((unit) => (
          <tr key={unit.unit_id}>
            <th scope="row">{wearerOf(unit)}</th>
            <td data-label={CHECKS.seconds}>{duration(1000 * unit.seconds)}</td>
            <td data-label={CHECKS.walked}>{Math.round(unit.walked_m)} m</td>
            <td data-label={CHECKS.closure}>{closureOf(unit)}</td>
            <td data-label={CHECKS.jumps}>{jumpsOf(unit)}</td>
            <td class="detail" data-label={CHECKS.pins}>
              {unit.pin_residuals.map(pinWords).join("; ") || NOTHING}
            </td>
            <td class="detail" data-label={CHECKS.notUsed}>
              {unit.not_used.map(([reason, count]) => `${count} ${reason}`).join("; ") || NOTHING}
            </td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
