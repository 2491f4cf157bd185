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
import { duration, percent, positioningReason } from "../format";
import { codedTexts } from "../live/codedText";
import { length, listed } from "../language/measures";
import { t } from "../language/translate";
import { Columns } from "./Columns";

/** Contents of an accuracy report. */
export function AccuracyReport({ report }: { report: Assessment }) {
  return (
    <>
      {!report.is_newest && <p class="warned">{t("assessment.late")}</p>}
      {codedTexts(report.flaws, report.flaw_codes).map((flaw) => (
        <p key={flaw} class="warned">
          {flaw}
        </p>
      ))}
      <Lights report={report} />
      <Errors report={report} />
      <dl class="terms">
        {TERMS.map(([term, key]) => (
          <div key={term}>
            <dt>{term}</dt>
            <dd>{t(key)}</dd>
          </div>
        ))}
      </dl>
      <Checks report={report} />
    </>
  );
}

const FIGURES = ["CE50", "CE95", "VE95", "SE95"];

function Errors({ report }: { report: Assessment }) {
  return (
    <table class="assessment stacked">
      <caption>{t("assessment.errors")}</caption>
      <Columns names={[t("assessment.person"), t("assessment.error"), ...FIGURES, t("assessment.floor_correct")]} />
      {report.units.map((unit) => (
        <ErrorRows
          key={unit.unit_id}
          name={wearerOf(unit)}
          figures={unit}
          floors={[unit.floor_probability, unit.floor_right]}
        />
      ))}
      <ErrorRows name={t("assessment.everybody")} figures={report} floors={[null, null]} />
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
        <th scope="row">{t("assessment.estimated_live")}</th>
        <Cells of={stated} />
        <td data-label={t("assessment.floor_correct")}>{share(floors[0])}</td>
      </tr>
      <tr>
        <th scope="row">
          {t("assessment.post_processed")}
          {tooSure(stated, known) && <strong class="warned"> {t("assessment.more_than_estimated")}</strong>}
        </th>
        <Cells of={known} />
        <td data-label={t("assessment.floor_correct")}>{share(floors[1])}</td>
      </tr>
    </tbody>
  );
}

function share(part: number | null): string {
  return part === null ? NOTHING : percent(part);
}

/** The trust light of each place at the time. */
function Lights({ report }: { report: Assessment }) {
  return (
    <table class="assessment stacked">
      <caption>{t("assessment.confidence")}</caption>
      <Columns
        names={[
          t("assessment.person"),
          t("assessment.lights"),
          t("assessment.for_how_long"),
          t("assessment.why_not_green"),
        ]}
      />
      <tbody>
        {report.units.map((unit) => (
          <tr key={unit.unit_id}>
            <th scope="row">{wearerOf(unit)}</th>
            <td>
              <LightBar trust={unit.trust} />
            </td>
            <td>{lightWords(unit.trust)}</td>
            <td class="detail" data-label={t("assessment.why_not_green")}>
              {unit.trust.causes.length === 0 && NOTHING}
              {unit.trust.causes.map(([cause, seconds]) => (
                <div key={cause}>
                  {positioningReason(cause)} {unbroken(seconds)}
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
  const times = [
    [trust.green_s, "assessment.green"],
    [trust.amber_s, "assessment.amber"],
    [trust.red_s, "assessment.red"],
  ] as const;
  const words = times.filter(([seconds]) => seconds > 0);
  return listed(words.map(([seconds, key]) => t(key, { time: unbroken(seconds) }))) || NOTHING;
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

const CHECKS = [
  "assessment.shown_for",
  "assessment.walked",
  "assessment.closure",
  "assessment.jumps",
  "assessment.pins",
  "assessment.not_used",
] as const;

function Checks({ report }: { report: Assessment }) {
  return (
    <table class="assessment stacked">
      <caption>{t("assessment.checks")}</caption>
      <Columns names={[t("assessment.person"), ...CHECKS.map((key) => t(key))]} />
      <tbody>
        {report.units.map((unit) => (
          <tr key={unit.unit_id}>
            <th scope="row">{wearerOf(unit)}</th>
            <td data-label={t("assessment.shown_for")}>{duration(1000 * unit.seconds)}</td>
            <td data-label={t("assessment.walked")}>{length(unit.walked_m, 0)}</td>
            <td data-label={t("assessment.closure")}>{closureOf(unit)}</td>
            <td data-label={t("assessment.jumps")}>{jumpsOf(unit)}</td>
            <td class="detail" data-label={t("assessment.pins")}>
              {unit.pin_residuals.map(pinWords).join("; ") || NOTHING}
            </td>
            <td class="detail" data-label={t("assessment.not_used")}>
              {unit.not_used.map(([reason, count]) => `${count} ${positioningReason(reason)}`).join("; ") || NOTHING}
            </td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
