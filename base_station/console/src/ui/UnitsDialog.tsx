import { useSignal } from "@preact/signals";
import { attempt, live, user } from "../sessions";
import * as api from "../api";
import { openDialog } from "../uiState";
import type { ClockView, PreflightView, UnitView, WornSensorView } from "../wire";
import { alarmLabel, clockOffset, gpsText, isClockWrong, linkText, wornAt } from "../format";
import { preflightText } from "../live/codedText";
import { label, t } from "../language/translate";
import { Columns } from "./Columns";
import { Dialog } from "./Dialog";
import { useDone } from "./Done";
import { Recording } from "./Recording";
import { useChosen } from "./useChosen";
import { fields, useLoaded } from "./useLoaded";
import { Wearer } from "./Wearer";

const RATES_HZ = [0.5, 1, 2, 5, 10];

export function UnitsDialog() {
  const [people] = useLoaded(api.people);
  const [details] = useLoaded(api.units);
  const picture = live.value?.picture;
  const ids = picture?.unitIds.value ?? [];
  return (
    <Dialog title={t("units.title")} wide>
      {user.value?.role === "administrator" && (
        <p class="row">
          <button type="button" onClick={() => openDialog("enrolments")}>
            {t("units.enrolments")}
          </button>
        </p>
      )}
      <RegisterForm />
      <table class="units stacked">
        <Columns
          names={[
            t("units.unit"),
            t("units.link"),
            t("units.clock"),
            t("units.gps"),
            t("units.assigned"),
            t("units.sensors"),
            t("units.calibration"),
            t("units.rate"),
            t("units.recording"),
          ]}
        />
        <tbody>
          {ids.map((unitId) => {
            const unit = picture?.unit(unitId)?.value;
            const described = details.value?.find((one) => one.unit_id === unitId);
            return (
              unit && (
                <UnitRow
                  key={unitId}
                  unit={unit}
                  people={people.value ?? []}
                  calibration={described?.calibration ?? ""}
                />
              )
            );
          })}
        </tbody>
      </table>
      {ids.length === 0 && (
        <p class="quiet">{t("units.none")}</p>
      )}
    </Dialog>
  );
}

interface RowProps {
  unit: UnitView;
  people: api.Person[];
  calibration: string;
}

function UnitRow({ unit, people, calibration }: RowProps) {
  const labelled = unit.label !== "" && unit.label !== unit.unit_id;
  return (
    <tr>
      <th scope="row">
        {labelled ? `${unit.label} (${unit.unit_id})` : unit.unit_id}
        <CheckAtStart preflight={unit.preflight} />
      </th>
      <td>
        {linkText(unit)}
        {unit.cloned && <small class="warned"> {t("member.duplicate")}</small>}
      </td>
      <td data-label={t("units.clock")}>
        <UnitClock clock={unit.clock} />
      </td>
      <td data-label={t("units.gps")}>{gpsText(unit.gps)}</td>
      <td data-label={t("units.assigned")}>
        {unit.registered ? <Wearer unit={unit} people={people} /> : <Register unit={unit} />}
      </td>
      <td data-label={t("units.sensors")}>
        <Sensors sensors={unit.sensors} tracker={unit.tracker} />
      </td>
      <td data-label={t("units.calibration")}>
        <Calibration unit={unit} calibration={calibration} />
      </td>
      <td data-label={t("units.rate")}>{unit.registered && <Rate unitId={unit.unit_id} />}</td>
      <td data-label={t("units.recording")}>{unit.registered && <Recording unitId={unit.unit_id} />}</td>
    </tr>
  );
}

/** By which the unit names its black box; nothing that is shown here goes by it. */
function UnitClock({ clock }: { clock: ClockView | null }) {
  if (clock === null) return <>{t("units.unknown")}</>;
  return <span class={isClockWrong(clock) ? "warned" : ""}>{clockOffset(clock)}</span>;
}

/** Where its wearer has each, and what makes positions of their samples. */
function Sensors({ sensors, tracker }: { sensors: readonly WornSensorView[]; tracker: string }) {
  if (tracker === "") return <>{t("units.unknown")}</>;
  return (
    <ul class="worn-sensors">
      {sensors.map((one) => (
        <li key={one.name} title={one.model}>
          {wornAt(one)}
        </li>
      ))}
      <li class="quiet">{label("tracker", tracker)}</li>
    </ul>
  );
}

/** Its name, and the station's objections to it. */
function Calibration({ unit, calibration }: { unit: UnitView; calibration: string }) {
  const alarms = live.value?.picture.alarms.value;
  const warning = unit.alarms
    .map((alarmId) => alarms?.get(alarmId))
    .find((alarm) => alarm?.rule === "calibration");
  return (
    <>
      {calibration === "" ? t("units.no_calibration") : calibration}
      {warning && <small class="warned"> {alarmLabel(warning)}</small>}
    </>
  );
}

/** Results of the unit's check at its start, as of `muster edge check`. */
function CheckAtStart({ preflight }: { preflight: PreflightView | null }) {
  if (preflight === null || preflight.level === "ok") return null;
  const level = preflight.level === "failed" ? "warned" : "quiet";
  return <small class={`check-at-start ${level}`}>{preflightText(preflight)}</small>;
}

function Rate({ unitId }: { unitId: string }) {
  const asked = useSignal("");
  const done = useDone(t("units.rate_asked", { rate: asked.value }));
  const chosen = useChosen("", (rateHz) => {
    if (rateHz === "") return;
    done.unsay();
    const sent = api.setPositionRate(unitId, Number(rateHz)).then(() => {
      asked.value = rateHz;
      done.say();
    });
    void attempt(sent);
  });
  return (
    <>
      <select aria-label={t("units.rate_of", { unit: unitId })} {...chosen}>
        <option value="">{t("units.default")}</option>
        {RATES_HZ.map((rateHz) => (
          <option key={rateHz} value={rateHz}>
            {rateHz}
          </option>
        ))}
      </select>{" "}
      {done.words}
    </>
  );
}

function Register({ unit }: { unit: UnitView }) {
  return (
    <button
      type="button"
      onClick={() => void attempt(api.registerUnit(unit.unit_id, unit.label || unit.unit_id))}
    >
      {t("units.register")}
    </button>
  );
}

function RegisterForm() {
  return (
    <form
      class="row"
      onSubmit={(event) => {
        const form = event.currentTarget;
        const { unit_id: unitId = "", label = "" } = fields(event);
        void attempt(api.registerUnit(unitId, label || unitId).then(() => form.reset()));
      }}
    >
      <label>
        {t("units.id")}
        <input name="unit_id" required maxLength={64} />
      </label>
      <label>
        {t("units.label")}
        <input name="label" maxLength={64} />
      </label>
      <button class="primary">{t("units.register")}</button>
    </form>
  );
}
