import type { ComponentChildren } from "preact";
import { listed } from "../language/measures";
import { hasAlarm } from "../live/alarms";
import type { Picture } from "../live/picture";
import { isOld, regionAt } from "../plan/ellipse";
import { roomWord } from "../plan/rooms";
import type { Link, PositionView, StatusView, UnitView } from "../wire";
import * as format from "../format";
import { label, t } from "../language/translate";
import { Icon, type IconName } from "./Icon";

interface Props {
  unit: UnitView;
  picture: Picture;
}

const LINK_LEVEL: Record<Link, string> = {
  live: "",
  never: "",
  stale: "caution",
  lost: "critical",
};

/** State of one person as names and values. */
export function Facts({ unit, picture }: Props) {
  const now = picture.nowMsOf(unit.unit_id);
  return (
    <dl class="facts">
      <Where unit={unit} picture={picture} />
      <Heard unit={unit} now={now} silent={picture.silentMs.value > 0} />
      <Environment unit={unit} now={now} />
      <Electronics status={unit.status} />
      <Battery status={unit.status} low={hasAlarm(unit, "battery", picture.alarms.value)} />
      <Inside unit={unit} now={now} />
    </dl>
  );
}

/** State of a person who is well, in one line. */
export function BriefFacts({ unit, picture }: Props) {
  const { position, ambient_degc, ambient_ms } = unit;
  if (position === null) return null;
  const now = picture.nowMsOf(unit.unit_id);
  const old = isOld(position, now) || picture.silentMs.value > 0;
  return (
    <p class={`brief-facts ${old ? "old" : ""}`}>
      {placeWords(position, picture, old)}
      <span class="spoken">, {format.place(position)}</span>
      {ambient_degc !== null && ` · ${format.temperature(ambient_degc)}`}
      {format.isReadingOld(ambient_ms, now) && ambient_ms !== null && (
        <small class="old-mark">{t("measure.old", { age: format.age(now - ambient_ms) })}</small>
      )}
      {old && <small class="old-mark">{t("measure.old", { age: format.age(now - position.t_ms) })}</small>}
    </p>
  );
}

/** "ground floor, near store, ± 2.1 m". */
export function placeWords(position: PositionView, picture: Picture, old: boolean): string {
  const region = regionAt(position, picture.silentMs.value);
  const room = roomWord(picture.plan.value, position, region);
  const parts = [format.floorOf(position, old), room, format.plusMinus(region.major_m)];
  return listed(parts.filter((part) => part !== ""));
}

function Where({ unit, picture }: Props) {
  const { position } = unit;
  const now = picture.nowMsOf(unit.unit_id);
  if (position === null) {
    return (
      <Fact icon="floor" label={t("fact.position")} width="wide">
        {t(unit.duty !== null && !unit.duty.located ? "card.not_located" : "card.no_position")}
      </Fact>
    );
  }
  const old = isOld(position, now);
  return (
    <Fact icon="floor" label={t("fact.position")} level={old ? "old" : ""} width="wide">
      {placeWords(position, picture, old)}
      <span class="spoken">, {format.place(position)}</span>
      {old && <small class="old-mark">{t("measure.old", { age: format.age(now - position.t_ms) })}</small>}
    </Fact>
  );
}

interface HeardProps {
  unit: UnitView;
  now: number;
  silent: boolean; // no contact with the station, so the unit's link is unknown
}

function Heard({ unit, now, silent }: HeardProps) {
  const good = unit.link === "live" && !unit.switched_off && !silent;
  const level = unit.switched_off ? "" : LINK_LEVEL[unit.link];
  return (
    <Fact
      icon={good ? "linkGood" : "linkLost"}
      label={silent ? t("fact.not_updated") : format.linkText(unit)}
      level={silent ? "critical" : level}
    >
      {unit.last_heard_ms === null ? "—" : t("measure.ago", { age: format.age(now - unit.last_heard_ms) })}
    </Fact>
  );
}

function Environment({ unit, now }: { unit: UnitView; now: number }) {
  const { ambient_degc, ambient_ms } = unit;
  const old = format.isReadingOld(ambient_ms, now);
  const sensors = format.sensorsText(unit.ambient_sensors);
  return (
    <Fact icon="heat" label={t("fact.environment")} level={unit.heat_level || (old ? "old" : "")}>
      {format.temperature(ambient_degc)}
      {ambient_degc !== null && <Remark>{format.heatText(unit.heat_level)}</Remark>}
      {sensors !== "" && <Remark>{sensors}</Remark>}
      {old && ambient_ms !== null && (
        <small class="old-mark">{t("measure.old", { age: format.age(now - ambient_ms) })}</small>
      )}
    </Fact>
  );
}

/** Inside the unit: nothing where it has no such sensor. */
function Electronics({ status }: { status: StatusView | null }) {
  const degc = format.hottest(status?.electronics ?? []);
  if (degc === null) return null;
  return (
    <Fact icon="heat" label={t("fact.electronics")}>
      {format.temperature(degc)}
    </Fact>
  );
}

function Battery({ status, low }: { status: StatusView | null; low: boolean }) {
  const state = status === null ? "" : format.batteryText(status);
  return (
    <Fact icon="battery" label={t("fact.battery")} level={low ? "warning" : ""}>
      {format.percent(status?.battery ?? null)}
      {low && <Remark>{t("fact.battery_low")}</Remark>}
      {state !== "" && <Remark>{state}</Remark>}
    </Fact>
  );
}

/** Places of the sensors on the body, and the tracker of their samples. */
export function Sensors({ unit: { sensors, tracker } }: { unit: UnitView }) {
  if (tracker === "") return null;
  return (
    <dl class="facts">
      <Fact icon="walking" label={t("fact.sensors")} width="whole">
        {listed(sensors.map(format.wornAt))}
        <Remark>{label("tracker", tracker)}</Remark>
      </Fact>
    </dl>
  );
}

function Inside({ unit, now }: { unit: UnitView; now: number }) {
  const restSinceMs = unit.duty?.rest_since_ms ?? null;
  if (restSinceMs !== null) {
    return (
      <Fact icon="clock" label={t("fact.in_rehab")}>
        {format.minutes(now - restSinceMs)}
      </Fact>
    );
  }
  const insideMs = format.insideMs(unit, now);
  return (
    <Fact icon="inside" label={format.insideText(unit)}>
      {insideMs === null ? "—" : format.minutes(insideMs)}
    </Fact>
  );
}

/** Behind a figure, and read aloud as a word of its own. */
function Remark({ children }: { children: ComponentChildren }) {
  return (
    <>
      {"\u00a0"}
      <small>{children}</small>
    </>
  );
}

interface FactProps {
  icon: IconName;
  label: string;
  level?: string;
  width?: "" | "wide" | "whole";
  children: ComponentChildren;
}

function Fact({ icon, label, level = "", width = "", children }: FactProps) {
  return (
    <div class={`fact ${level} ${width}`}>
      <dt>
        <Icon name={icon} />
        {label}
      </dt>
      <dd>{children}</dd>
    </div>
  );
}
