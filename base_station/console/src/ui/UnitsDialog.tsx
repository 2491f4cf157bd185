import { attempt, live } from "../sessions";
import { dialogUnit } from "../view";
import * as api from "../api";
import type { UnitView } from "../wire";
import { linkWord } from "../words";
import { Dialog } from "./Dialog";
import { fields, useLoaded } from "./useLoaded";

export function UnitsDialog() {
  const [people] = useLoaded(api.people);
  const picture = live.value?.picture;
  const ids = picture?.unitIds.value ?? [];
  return (
    <Dialog title="Units and who wears them">
      <RegisterForm />
      <table>
        <thead>
          <tr>
            <th scope="col">Unit</th>
            <th scope="col">Link</th>
            <th scope="col">Worn by</th>
          </tr>
        </thead>
        <tbody>
          {ids.map((unitId) => {
            const unit = picture?.unit(unitId)?.value;
            return unit && <UnitRow key={unitId} unit={unit} people={people.value ?? []} />;
          })}
        </tbody>
      </table>
    </Dialog>
  );
}

function UnitRow({ unit, people }: { unit: UnitView; people: api.Person[] }) {
  const label = unit.label === "" ? unit.unit_id : `${unit.label} (${unit.unit_id})`;
  return (
    <tr>
      <th scope="row">{label}</th>
      <td>{linkWord(unit.link)}</td>
      <td>{unit.registered ? <Wearer unit={unit} people={people} /> : <Register unit={unit} />}</td>
    </tr>
  );
}

function Wearer({ unit, people }: { unit: UnitView; people: api.Person[] }) {
  const change = (personId: string) =>
    void attempt(personId === "" ? api.unassign(unit.unit_id) : api.assign(unit.unit_id, personId));
  return (
    <select
      aria-label={`Who wears ${unit.unit_id}`}
      value={unit.person?.person_id ?? ""}
      onChange={(event) => change(event.currentTarget.value)}
    >
      <option value="">nobody</option>
      {people.map((person) => (
        <option key={person.person_id} value={person.person_id}>
          {person.name} ({person.crew})
        </option>
      ))}
    </select>
  );
}

function Register({ unit }: { unit: UnitView }) {
  return (
    <button
      type="button"
      onClick={() => void attempt(api.registerUnit(unit.unit_id, unit.label || unit.unit_id))}
    >
      Register as ours
    </button>
  );
}

function RegisterForm() {
  return (
    <form
      class="row"
      onSubmit={(event) => {
        const { unit_id: unitId = "", label = "" } = fields(event);
        void attempt(api.registerUnit(unitId, label || unitId));
      }}
    >
      <label>
        Unit id
        <input name="unit_id" required maxLength={64} value={dialogUnit.value ?? ""} />
      </label>
      <label>
        Label
        <input name="label" maxLength={64} />
      </label>
      <button class="primary">Register unit</button>
    </form>
  );
}
