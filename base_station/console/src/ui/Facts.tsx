import type { ComponentChildren } from "preact";
import { hasAlarm } from "../live/alarms";
import type { Picture } from "../live/picture";
import { isOld, regionAt } from "../plan/ellipse";
import { roomWord } from "../plan/rooms";
import type { Link, PositionView, UnitView } from "../wire";
import * as words from "../words";
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

/** What is known of one person, each with its name. */
export function Facts({ unit, picture }: Props) {
  const now = picture.nowMs.value;
  return (
    <dl class="facts">
      <Where unit={unit} picture={picture} />
      <Heard unit={unit} now={now} silent={picture.silentMs.value > 0} />
      <Fact icon="heat" label="Environment" level={unit.heat_level}>
        {words.temperature(unit.ambient_degc)}
        {unit.ambient_degc !== null && <Remark>{words.heatWord(unit.heat_level)}</Remark>}
      </Fact>
      <Battery
        part={unit.status?.battery ?? null}
        low={hasAlarm(unit, "battery", picture.alarms.value)}
      />
      <Inside unit={unit} now={now} />
    </dl>
  );
}

/** The same of somebody who is well, in one line. */
export function BriefFacts({ unit, picture }: Props) {
  const { position, ambient_degc } = unit;
  if (position === null) return null;
  const now = picture.nowMs.value;
  const old = isOld(position, now) || picture.silentMs.value > 0;
  return (
    <p class={`brief-facts ${old ? "old" : ""}`}>
      {placeWords(position, picture, old)}
      <span class="spoken">, {words.place(position)}</span>
      {ambient_degc !== null && ` · ${words.temperature(ambient_degc)}`}
      {old && <small class="old-mark">{words.age(now - position.t_ms)} old</small>}
    </p>
  );
}

/** "ground floor, near store, ± 2.1 m". */
function placeWords(position: PositionView, picture: Picture, old: boolean): string {
  const region = regionAt(position, picture.silentMs.value);
  const room = roomWord(picture.plan.value, position, region);
  const parts = [words.floorOf(position, old), room, words.plusMinus(region.major_m)];
  return parts.filter((part) => part !== "").join(", ");
}

function Where({ unit, picture }: Props) {
  const { position } = unit;
  const now = picture.nowMs.value;
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
      {placeWords(position, picture, old)}
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
  const good = unit.link === "live" && !unit.switched_off && !silent;
  const level = unit.switched_off ? "" : LINK_LEVEL[unit.link];
  return (
    <Fact
      icon={good ? "linkGood" : "linkLost"}
      label={silent ? "Not updated" : words.linkWord(unit)}
      level={silent ? "critical" : level}
    >
      {unit.last_heard_ms === null ? "—" : `${words.age(now - unit.last_heard_ms)} ago`}
    </Fact>
  );
}

function Battery({ part, low }: { part: number | null; low: boolean }) {
  return (
    <Fact icon="battery" label="Battery" level={low ? "warning" : ""}>
      {words.percent(part)}
      {low && <Remark>low</Remark>}
    </Fact>
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
  const insideMs = words.insideMs(unit, now);
  return (
    <Fact icon="inside" label={words.insideWord(unit)}>
      {insideMs === null ? "—" : words.minutes(insideMs)}
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
