import { useSignal } from "@preact/signals";
import { attempt, live } from "../sessions";
import * as api from "../api";
import type { UnitView } from "../wire";
import { t } from "../language/translate";
import { useChosen } from "./useChosen";
import { useLoaded } from "./useLoaded";

/** Choice of the wearer of a unit; the people are listed when the element gets the focus, as hundreds of
 * units with hundreds of people each would block the page for a minute. */
export function Wearer({ unit, people }: { unit: UnitView; people: readonly api.Person[] }) {
  const change = (personId: string) =>
    void attempt(personId === "" ? api.unassign(unit.unit_id) : api.assign(unit.unit_id, personId));
  const wornBy = unit.person?.person_id ?? "";
  const chosen = useChosen(wornBy, change);
  const isAsked = useSignal(false);
  const ask = () => void (isAsked.value = true);
  const now = unit.person === null ? [] : [unit.person]; // known before the list is there
  const all = people.some((person) => person.person_id === wornBy) ? people : [...now, ...people];
  const listed = isAsked.value ? all : all.filter((person) => person.person_id === wornBy);
  return (
    <select
      aria-label={t("units.wearer_of", { unit: unit.unit_id })}
      {...chosen}
      onFocus={ask}
      onPointerEnter={ask}
    >
      <option value="">{t("units.unassigned")}</option>
      {listed.map((person) => (
        <option key={person.person_id} value={person.person_id}>
          {nameAndUnit(person, unit.unit_id)}
        </option>
      ))}
    </select>
  );
}

type Named = Pick<api.Person, "person_id" | "name" | "crew">;

function nameAndCrew({ name, crew }: Named): string {
  return crew === "" ? name : t("units.with_crew", { name, crew });
}

/** A member who gets another unit loses the previous one: "Ana (Engine 1), wears FF-02". */
function nameAndUnit(named: Named, unitId: string): string {
  const name = nameAndCrew(named);
  const units = live.peek()?.picture.unitsOfAll() ?? [];
  const other = units.find(({ unit_id, person }) => unit_id !== unitId && person?.person_id === named.person_id);
  return other === undefined ? name : t("units.wears", { name, unit: other.label || other.unit_id });
}

/** On the card of a unit without a wearer. */
export function AskWearer({ unit }: { unit: UnitView }) {
  const [people] = useLoaded(api.people);
  return (
    <label class="ask-wearer">
      {t("units.assign")} <Wearer unit={unit} people={people.value ?? []} />
    </label>
  );
}
