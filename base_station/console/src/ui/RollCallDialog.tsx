import { attempt, mayAct, picture as shown } from "../sessions";
import { openDialog } from "../view";
import * as api from "../api";
import { needsOf } from "../live/alarms";
import type { Target } from "../live/commands";
import { crewsOnDuty, type CrewOnDuty, type OnDuty } from "../live/duty";
import { displayName } from "../live/urgency";
import { alarmWord, clockTime, minutes } from "../words";
import { ConfirmButton } from "./ConfirmButton";
import { Dialog } from "./Dialog";
import { useSteady } from "./haste";
import { Icon } from "./Icon";
import { ParMark } from "./ParClock";

/** Ticking people off: one press for each, or for a crew, or for everyone. */
export function RollCallDialog() {
  const picture = shown.value;
  if (picture === null) return null;
  void picture.unitsChanged.value;
  const incident = picture.incident.value;
  const crews = crewsOnDuty(picture.allUnits(), incident, picture.nowMs.value);
  return (
    <Dialog title="Roll call (PAR)" wide>
      {crews.length === 0 && (
        <p>Nobody is on duty: open an incident, and say in Units who wears which unit.</p>
      )}
      {mayAct.value && crews.length > 0 && (
        <p class="row roll-all">
          <span>Tick off whom you have heard. Nothing that a unit measures does it for you.</span>
          <button type="button" onClick={() => openDialog("par_request")}>
            Ask by radio
          </button>
          <ConfirmButton
            label="All heard"
            question={`Has everybody answered${named(inNeed(crews, picture))}?`}
            onConfirm={() => tick({ everyone: true })}
          />
        </p>
      )}
      {crews.map((crew, i) => (
        <Crew key={crew.crew} crew={crew} place={peopleIn(crews.slice(0, i))} picture={picture} />
      ))}
    </Dialog>
  );
}

type Shown = NonNullable<(typeof shown)["value"]>;

interface CrewProps {
  crew: CrewOnDuty;
  place: number; // how many people stand above
  picture: Shown;
}

function Crew({ crew, place, picture }: CrewProps) {
  const steady = useSteady(place);
  const name = crew.crew === "" ? "Without a crew" : crew.crew;
  const all = () => tick({ crew: crew.crew });
  const needy = inNeed([crew], picture);
  return (
    <section class={`roll-crew ${crew.par.state}`} aria-label={name}>
      <header>
        <h3>
          {name} <span class="quiet">{crew.people.length} on duty</span>
        </h3>
        {mayAct.value && crew.crew !== "" && crew.people.length > 1 && needy.length === 0 && (
          <button type="button" onClick={steady(all)}>
            {name}: all heard
          </button>
        )}
        {mayAct.value && crew.crew !== "" && crew.people.length > 1 && needy.length > 0 && (
          <ConfirmButton
            label={`${name}: all heard`}
            yes="Yes, all heard"
            question={`Have all answered${named(needy)}?`}
            onConfirm={steady(all)}
          />
        )}
      </header>
      <ul>
        {crew.people.map((one, i) => (
          <Row key={one.unit.unit_id} one={one} place={place + i} picture={picture} />
        ))}
      </ul>
    </section>
  );
}

function Row({ one, place, picture }: { one: OnDuty; place: number; picture: Shown }) {
  const steady = useSteady(place);
  const { unit, duty } = one;
  const needs = needsOf(unit, picture.alarms.value);
  const name = displayName(unit);
  return (
    <li class={one.par.state}>
      <span class="roll-name">
        <strong>{name}</strong>
        {needs.length > 0 && (
          <span class="in-need">
            <Icon name="alarm" />
            {needs.map(alarmWord).join(", ")}
          </span>
        )}
      </span>
      <ParMark unit={unit} picture={picture} />
      <span class="quiet">
        last heard {clockTime(duty.checked_in_ms)} by {duty.checked_in_by}
        {duty.rest_since_ms !== null &&
          `, resting for ${minutes(picture.nowMs.value - duty.rest_since_ms)}`}
        {duty.work_since_ms !== null &&
          `, at work for ${minutes(picture.nowMs.value - duty.work_since_ms)}`}
      </span>
      {mayAct.value && (
        <button
          type="button"
          class="primary tick"
          aria-label={`Heard ${name}`}
          onClick={steady(() => tick({ unit_id: unit.unit_id }))}
        >
          Heard
        </button>
      )}
    </li>
  );
}

/** Whose answer nobody should take for granted. */
function inNeed(crews: readonly CrewOnDuty[], picture: Shown): string[] {
  const people = crews.flatMap((crew) => crew.people);
  const needy = people.filter(({ unit }) => needsOf(unit, picture.alarms.value).length > 0);
  return needy.map(({ unit }) => displayName(unit));
}

function named(names: readonly string[]): string {
  return names.length === 0 ? "" : `, ${names.join(" and ")} too`;
}

function peopleIn(crews: readonly CrewOnDuty[]): number {
  return crews.reduce((sum, crew) => sum + crew.people.length, 0);
}

function tick(target: Target): void {
  void attempt(api.checkIn(target));
}
