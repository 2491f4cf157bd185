import { useSignal } from "@preact/signals";
import * as api from "../api";
import { attempt } from "../sessions";
import { rich, t } from "../language/translate";
import "../styles/setup.css";
import { Photo } from "./Photo";
import { fields } from "./useLoaded";
import { compareNames } from "../language/measures";

const PERSON = "text/x-muster-person";

interface Props {
  people: readonly api.Person[];
  done: () => void;
}

/** All people by crew.  People are dragged to another crew, or selected and moved by a button, for
 * keyboards and touch screens; a picture dropped on a person becomes the photo. */
export function CrewBoard({ people, done }: Props) {
  const picked = useSignal<ReadonlySet<string>>(new Set());
  const added = useSignal<readonly string[]>([]);
  const crews = [...new Set([...people.map((one) => one.crew), ...added.value, ""])].sort(noneLast);
  const pick = (personId: string) => {
    const others = new Set(picked.value);
    if (!others.delete(personId)) others.add(personId);
    picked.value = others;
  };
  const move = (ids: ReadonlySet<string>, crew: string) => {
    const moved = people.filter((one) => ids.has(one.person_id) && one.crew !== crew);
    picked.value = new Set();
    void attempt(moveAll(moved, crew)).then(done); // also where some were moved before it broke off
  };
  const drop = (personId: string, crew: string) =>
    move(picked.value.has(personId) ? picked.value : new Set([personId]), crew);
  return (
    <section aria-label={t("crew.title")}>
      <p class="quiet">{rich("crew.hint", { move: <em>{t("crew.move_here")}</em> })}</p>
      <div class="crew-board">
        {crews.map((crew) => (
          <Crew
            key={crew}
            crew={crew}
            members={people.filter((one) => one.crew === crew)}
            picked={picked.value}
            pick={pick}
            moveHere={() => move(picked.value, crew)}
            drop={(personId) => drop(personId, crew)}
            done={done}
          />
        ))}
      </div>
      <form
        class="row"
        onSubmit={(event) => {
          const { crew = "" } = fields(event);
          added.value = [...added.value, crew];
          event.currentTarget.reset();
        }}
      >
        <label>
          {t("crew.new")}
          <input name="crew" required maxLength={60} autocomplete="off" />
        </label>
        <button>{t("crew.add")}</button>
      </form>
    </section>
  );
}

interface CrewProps {
  crew: string;
  members: readonly api.Person[];
  picked: ReadonlySet<string>;
  pick: (personId: string) => void;
  moveHere: () => void;
  drop: (personId: string) => void;
  done: () => void;
}

function Crew({ crew, members, picked, pick, moveHere, drop, done }: CrewProps) {
  const over = useSignal(false);
  const name = crew === "" ? t("crew.none") : crew;
  const others = members.filter((one) => picked.has(one.person_id)).length < picked.size;
  return (
    <section
      class={over.value ? "drop-here" : ""}
      aria-label={name}
      onDragOver={(event) => {
        if (!event.dataTransfer?.types.includes(PERSON)) return;
        event.preventDefault();
        over.value = true;
      }}
      onDragLeave={() => (over.value = false)}
      onDrop={(event) => {
        over.value = false;
        const personId = event.dataTransfer?.getData(PERSON) ?? "";
        if (personId === "") return;
        event.preventDefault();
        drop(personId);
      }}
    >
      <h3>
        {t("crew.count", { crew: name, count: members.length })}
      </h3>
      <ul>
        {members.map((person) => (
          <Member
            key={person.person_id}
            person={person}
            isPicked={picked.has(person.person_id)}
            pick={() => pick(person.person_id)}
            done={done}
          />
        ))}
      </ul>
      {others && (
        <button type="button" aria-label={t("common.about", { action: t("crew.move_here"), what: name })} onClick={moveHere}>
          {t("crew.move_here")}
        </button>
      )}
    </section>
  );
}

interface MemberProps {
  person: api.Person;
  isPicked: boolean;
  pick: () => void;
  done: () => void;
}

function Member({ person, isPicked, pick, done }: MemberProps) {
  return (
    <li>
      <button
        type="button"
        class="person"
        draggable
        aria-pressed={isPicked}
        onClick={pick}
        onDragStart={(event) => event.dataTransfer?.setData(PERSON, person.person_id)}
        onDragOver={(event) => {
          if (event.dataTransfer?.types.includes("Files")) event.preventDefault();
        }}
        onDrop={(event) => {
          const photo = event.dataTransfer?.files[0];
          if (photo === undefined) return;
          event.preventDefault();
          void attempt(api.setPhoto(person.person_id, photo)).then(done);
        }}
      >
        <Photo name={person.name} url={person.photo_url} />
        <span>
          {person.name}
          {person.role !== "" && <small class="quiet"> {person.role}</small>}
        </span>
      </button>
    </li>
  );
}

/** One after the other: after a refusal the previous ones stay moved, as the board shows. */
async function moveAll(people: readonly api.Person[], crew: string): Promise<void> {
  for (const { person_id: personId, name, role } of people) {
    await api.changePerson(personId, { name, crew, role });
  }
}

function noneLast(one: string, other: string): number {
  return Number(one === "") - Number(other === "") || compareNames(one, other);
}
