import type { ComponentChildren } from "preact";
import { memo } from "preact/compat";
import { attempt, mayAct } from "../sessions";
import * as api from "../api";
import { select, selectedUnit } from "../view";
import type { Picture } from "../live/picture";
import { displayName, type Urgency } from "../live/urgency";
import { isOld, regionAt } from "../plan/ellipse";
import type { AlarmView, Link, UnitView } from "../wire";
import * as words from "../words";
import { CardActions } from "./CardActions";
import { OpenCommands } from "./CommandState";
import { activityIcon, Icon, type IconName } from "./Icon";
import { ParMark } from "./ParClock";
import { Photo } from "./Photo";
import { AskWearer } from "./Wearer";

interface Props {
  unitId: string;
  urgency: Urgency;
  picture: Picture;
}

const LOW_BATTERY = 0.1;
const LINK_LEVEL: Record<Link, string> = {
  live: "",
  never: "",
  stale: "caution",
  lost: "critical",
};

export const Card = memo(({ unitId, urgency, picture }: Props) => {
  const unit = picture.unit(unitId)?.value;
  if (unit === undefined) return null;
  const name = displayName(unit);
  const chosen = selectedUnit.value === unitId;
  const unheard = unit.link === "lost" || unit.link === "never";
  return (
    <li
      class={`card ${urgency} ${unheard ? "unheard" : ""} ${chosen ? "chosen" : ""}`}
      data-unit={unitId}
    >
      <button
        type="button"
        class="card-head"
        aria-pressed={chosen}
        title="Show on the plan"
        onClick={() => select(unitId, unit.position?.floor ?? null)}
      >
        <Photo name={name} url={unit.person?.photo_url ?? null} />
        <span class="names">
          <span class="name">{name}</span>
          <span class="under-name">
            <span class="quiet">{crewAndRole(unit)}</span>
            <ParMark unit={unit} picture={picture} />
          </span>
          <Activity unit={unit} />
        </span>
      </button>
      <OpenAlarms unit={unit} alarms={picture.alarms.value} />
      {unit.cloned && <TwoMachines />}
      <OpenCommands unitId={unitId} commands={picture.commands.value} />
      <Facts unit={unit} picture={picture} />
      <Trust unit={unit} />
      {chosen && mayAct.value && unit.registered && <CardActions unit={unit} />}
      {!unit.registered && <UnknownUnit unitId={unitId} />}
      {unit.registered && unit.person === null && mayAct.value && <AskWearer unit={unit} />}
    </li>
  );
});

function crewAndRole(unit: UnitView): string {
  if (unit.person === null) return unit.registered ? "nobody assigned" : "unknown unit";
  return [unit.person.crew, unit.person.role].filter((word) => word !== "").join(" · ");
}

function Activity({ unit }: { unit: UnitView }) {
  const mayday = unit.status?.mayday ?? false;
  return (
    <span class={`activity ${mayday ? "mayday" : ""}`}>
      <Icon name={mayday ? "alarm" : activityOrNone(unit)} />
      {words.activityOf(unit)}
    </span>
  );
}

function activityOrNone(unit: UnitView): IconName {
  return unit.status === null ? "linkLost" : activityIcon(unit.status.activity);
}

function OpenAlarms({ unit, alarms }: { unit: UnitView; alarms: ReadonlyMap<string, AlarmView> }) {
  const open = unit.alarms.map((id) => alarms.get(id)).filter((alarm) => alarm !== undefined);
  if (open.length === 0) return null;
  return (
    <ul class="card-alarms" aria-label="Open alarms of this person">
      {open.map((alarm) => (
        <li key={alarm.alarm_id} class={`p${alarm.priority}`}>
          <Icon name="alarm" />
          {words.alarmWord(alarm)}
        </li>
      ))}
    </ul>
  );
}

function Facts({ unit, picture }: { unit: UnitView; picture: Picture }) {
  const now = picture.nowMs.value;
  return (
    <dl class="facts">
      <Where unit={unit} now={now} silentMs={picture.silentMs.value} />
      <Heard unit={unit} now={now} silent={picture.silentMs.value > 0} />
      <Fact icon="heat" label="Environment" level={unit.heat_level}>
        {words.temperature(unit.ambient_degc)}
        {unit.ambient_degc !== null && <small>{words.heatWord(unit.heat_level)}</small>}
      </Fact>
      <Battery part={unit.status?.battery ?? null} />
      <Inside unit={unit} now={now} />
    </dl>
  );
}

function Inside({ unit, now }: { unit: UnitView; now: number }) {
  const restSinceMs = unit.duty?.rest_since_ms ?? null;
  if (restSinceMs !== null) {
    return (
      <Fact icon="clock" label="Resting for">
        {words.minutes(now - restSinceMs)}
      </Fact>
    );
  }
  return (
    <Fact icon="inside" label="Inside for">
      {unit.inside_since_ms === null ? "—" : words.minutes(now - unit.inside_since_ms)}
    </Fact>
  );
}

interface WhereProps {
  unit: UnitView;
  now: number;
  silentMs: number;
}

function Where({ unit, now, silentMs }: WhereProps) {
  const { position } = unit;
  if (position === null) {
    return (
      <Fact icon="floor" label="Position" wide>
        no position yet
      </Fact>
    );
  }
  const old = isOld(position, now);
  return (
    <Fact icon="floor" label="Position" level={old ? "old" : ""} wide>
      {words.floorOf(position)}, {words.plusMinus(regionAt(position, silentMs).major_m)}
      <span class="spoken">, {words.place(position)}</span>
      {old && <small class="old-mark">{words.age(now - position.t_ms)} old</small>}
    </Fact>
  );
}

interface HeardProps {
  unit: UnitView;
  now: number;
  silent: boolean; // the station cannot be heard, so nobody knows of the unit's link
}

function Heard({ unit, now, silent }: HeardProps) {
  const good = unit.link === "live" && !silent;
  const level = silent ? "critical" : LINK_LEVEL[unit.link];
  return (
    <Fact
      icon={good ? "linkGood" : "linkLost"}
      label={silent ? "Not updated" : words.linkWord(unit.link)}
      level={level}
    >
      {unit.last_heard_ms === null ? "—" : `${words.age(now - unit.last_heard_ms)} ago`}
    </Fact>
  );
}

function Battery({ part }: { part: number | null }) {
  const low = part !== null && part < LOW_BATTERY;
  return (
    <Fact icon="battery" label="Battery" level={low ? "warning" : ""}>
      {words.percent(part)}
      {low && <small>low</small>}
    </Fact>
  );
}

interface FactProps {
  icon: IconName;
  label: string;
  level?: string;
  wide?: boolean;
  children: ComponentChildren;
}

function Fact({ icon, label, level = "", wide = false, children }: FactProps) {
  return (
    <div class={`fact ${level} ${wide ? "wide" : ""}`}>
      <dt>
        <Icon name={icon} />
        {label}
      </dt>
      <dd>{children}</dd>
    </div>
  );
}

/** How far the position can be trusted: nothing to say while that is well. */
function Trust({ unit }: { unit: UnitView }) {
  const { level, reason } = unit.trust;
  if (unit.position === null || level === "green") return null;
  const word = level === "red" ? "Do not trust this place" : "Place uncertain";
  return (
    <p class={`trust ${level}`}>
      <Icon name="target" />
      {reason === "" ? word : `${word}: ${reason}`}
    </p>
  );
}

/** Somebody is not seen, and what is shown may be the other. */
function TwoMachines() {
  return (
    <p class="trust red">
      <Icon name="people" />
      Somebody may be unseen: {words.TWO_MACHINES}
    </p>
  );
}

function UnknownUnit({ unitId }: { unitId: string }) {
  return (
    <p class="unknown">
      Not one of ours yet: kept in the log, not believed.
      {mayAct.value && (
        <button type="button" onClick={() => void attempt(api.registerUnit(unitId, unitId))}>
          Register
        </button>
      )}
    </p>
  );
}
