import { attempt } from "../sessions";
import * as api from "../api";
import type { UnitView } from "../wire";
import { useChosen } from "./useChosen";
import { useLoaded } from "./useLoaded";

/** Who wears a unit, to be chosen among the people. */
export function Wearer({ unit, people }: { unit: UnitView; people: readonly api.Person[] }) {
  const change = (personId: string) =>
    void attempt(personId === "" ? api.unassign(unit.unit_id) : api.assign(unit.unit_id, personId));
  const chosen = useChosen(unit.person?.person_id ?? "", change);
  return (
    <select aria-label={`Who wears ${unit.unit_id}`} {...chosen}>
      <option value="">nobody</option>
      {people.map((person) => (
        <option key={person.person_id} value={person.person_id}>
          {person.crew === "" ? person.name : `${person.name} (${person.crew})`}
        </option>
      ))}
    </select>
  );
}

/** On the card of a unit that nobody wears yet. */
export function AskWearer({ unit }: { unit: UnitView }) {
  const [people] = useLoaded(api.people);
  return (
    <label class="ask-wearer">
      Who wears it? <Wearer unit={unit} people={people.value ?? []} />
    </label>
  );
}
