import { attempt, mayAct, picture as shown } from "../sessions";
import { openDialog } from "../uiState";
import * as api from "../api";
import { needsOf } from "../live/alarms";
import { confirmationWords, crewsOnDuty, type CrewOnDuty, type OnDuty } from "../live/duty";
import { displayName } from "../live/urgency";
import { confirmPar } from "../undo";
import type { UnitView } from "../wire";
import { alarmLabel, minutes } from "../format";
import { ByRadio } from "./ByRadio";
import { ConfirmButton } from "./ConfirmButton";
import { Dialog } from "./Dialog";
import { useGuardedPress } from "./useGuardedPress";
import { Icon } from "./Icon";
import { ParMark } from "./ParClock";

/** PAR of each member: by own unit, by radio, or not yet; one press enters an answer by radio. */
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
          <span>
            Confirm each member who has answered by radio. Nothing that a unit measures confirms a PAR.
          </span>
          <button type="button" onClick={() => openDialog("par_request")}>
            Send PAR request
          </button>
          <ByRadio
            label="Confirm all"
            members={unitsIn(crews)}
            question="Has everybody answered by radio?"
            always
            onConfirm={() => void confirmPar({ everyone: true }, "everybody")}
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
  const steady = useGuardedPress(place);
  const name = crew.crew === "" ? "Without a crew" : crew.crew;
  const all = () => void confirmPar({ crew: crew.crew }, name);
  return (
    <section class={`roll-crew ${crew.par.state}`} aria-label={name}>
      <header>
        <h3>
          {name} <span class="quiet">{crew.people.length} on duty</span>
        </h3>
        {mayAct.value && crew.crew !== "" && crew.people.length > 1 && (
          <ByRadio
            label={`${name}: confirm all`}
            members={unitsIn([crew])}
            question="Have all answered by radio?"
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
  const steady = useGuardedPress(place);
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
            {needs.map(alarmLabel).join(", ")}
          </span>
        )}
      </span>
      <ParMark unit={unit} picture={picture} brief />
      <span class="quiet roll-words">
        {confirmationWords(duty)}
        {!duty.located && ", not located"}
        {duty.rest_since_ms !== null &&
          `, resting for ${minutes(picture.nowMs.value - duty.rest_since_ms)}`}
        {duty.work_since_ms !== null &&
          `, at work for ${minutes(picture.nowMs.value - duty.work_since_ms)}`}
      </span>
      {mayAct.value && (
        <span class="roll-acts">
          {duty.entry_id !== "" && (
            <ConfirmButton
              label="Undo"
              about={`PAR of ${name} by radio`}
              question={`PAR of ${name} counts as not answered by radio?`}
              onConfirm={() => void attempt(api.undoCheckIn(duty.entry_id, unit.unit_id))}
            />
          )}
          <ByRadio
            label="Confirm by radio"
            about={name}
            members={[unit]}
            question={`Has ${name} answered by radio?`}
            kind="primary tick"
            onConfirm={steady(() => void confirmPar({ unit_id: unit.unit_id }, name))}
          />
        </span>
      )}
    </li>
  );
}

function unitsIn(crews: readonly CrewOnDuty[]): UnitView[] {
  return crews.flatMap((crew) => crew.people.map((one) => one.unit));
}

function peopleIn(crews: readonly CrewOnDuty[]): number {
  return unitsIn(crews).length;
}
