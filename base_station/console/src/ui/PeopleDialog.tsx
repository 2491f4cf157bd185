import { useSignal } from "@preact/signals";
import { attempt, user } from "../sessions";
import * as api from "../api";
import { compareNames } from "../language/measures";
import { t } from "../language/translate";
import { Columns } from "./Columns";
import { useFirstField, useFocusBack } from "./Confirm";
import { Dialog } from "./Dialog";
import { EraseForm } from "./EraseForm";
import { onDemand } from "./onDemand";
import { useSinglePress } from "./useGuardedPress";
import { Photo } from "./Photo";
import { useLoaded } from "./useLoaded";
import { Waiting } from "./Waiting";

const PeopleImport = onDemand(() => import("./PeopleImport").then((part) => part.PeopleImport));
const CrewBoard = onDemand(() => import("./CrewBoard").then((part) => part.CrewBoard));

const CREWS = "crews"; // the id of the list of names that a crew's field offers

export function PeopleDialog() {
  const [people, again] = useLoaded(api.people);
  const csv = useSignal<File | null>(null);
  const showsCrews = useSignal(false);
  const ended = () => {
    csv.value = null;
    again();
  };
  return (
    <Dialog title={t("people_list.title")} wide>
      <p class="row">
        <label>
          {t("person.csv")}
          <input
            type="file"
            accept=".csv,.txt,text/csv"
            onChange={(event) => {
              csv.value = event.currentTarget.files?.[0] ?? null;
              event.currentTarget.value = ""; // the same file, corrected, can be chosen again
            }}
          />
        </label>
        <button
          type="button"
          aria-pressed={showsCrews.value}
          onClick={() => (showsCrews.value = !showsCrews.value)}
        >
          {t("person.crews")}
        </button>
      </p>
      {csv.value !== null && <PeopleImport file={csv.value} done={ended} />}
      {showsCrews.value && people.value !== null ? (
        <CrewBoard people={people.value} done={again} />
      ) : (
        <PeopleList people={people.value} again={again} />
      )}
    </Dialog>
  );
}

function PeopleList({ people, again }: { people: readonly api.Person[] | null; again: () => void }) {
  const crews = [...new Set((people ?? []).map(({ crew }) => crew).filter((crew) => crew !== ""))].sort(compareNames);
  return (
    <>
      <datalist id={CREWS}>
        {crews.map((crew) => (
          <option key={crew} value={crew} />
        ))}
      </datalist>
      <PersonForm done={again} />
      <table class="stacked">
        <Columns names={[t("person.name"), t("person.crew"), t("person.role")]} spoken={t("person.change")} />
        <tbody>
          {(people ?? []).map((person) => (
            <PersonRow key={person.person_id} person={person} done={again} />
          ))}
        </tbody>
      </table>
      {people === null && <Waiting />}
      {people?.length === 0 && <p class="quiet">{t("person.none")}</p>}
    </>
  );
}

interface RowProps {
  person: api.Person;
  done: () => void;
}

function PersonRow({ person, done }: RowProps) {
  const changing = useSignal(false);
  const button = useFocusBack(changing.value);
  if (changing.value) {
    const ended = () => {
      changing.value = false;
      done();
    };
    return (
      <tr>
        <td colSpan={4}>
          <ChangeForm person={person} done={ended} />
        </td>
      </tr>
    );
  }
  return (
    <tr>
      <th scope="row">
        <span class="person">
          <Photo name={person.name} url={person.photo_url} />
          {person.name}
        </span>
      </th>
      <td data-label={t("person.crew")}>{person.crew}</td>
      <td data-label={t("person.role")}>{person.role}</td>
      <td>
        <div class="row-actions">
          <button
            type="button"
            ref={button}
            aria-label={t("person.change_of", { name: person.name })}
            onClick={() => (changing.value = true)}
          >
            {t("person.change")}
          </button>
          {user.value?.role === "administrator" && (
            <EraseForm
              name={person.name}
              warning={t("person.erase")}
              subjectId={person.person_id}
              forget={(name) => api.forgetPerson(person.person_id, name)}
              done={done}
            />
          )}
        </div>
      </td>
    </tr>
  );
}

function ChangeForm({ person, done }: RowProps) {
  const form = useFirstField();
  return (
    <form
      class="row"
      ref={form}
      onSubmit={(event) => {
        event.preventDefault();
        void attempt(change(person, new FormData(event.currentTarget))).then((changed) => changed && done());
      }}
    >
      <PersonFields person={person} />
      <PhotoField />
      <button class="primary">{t("person.save")}</button>
      <button type="button" onClick={done}>
        {t("menu.cancel")}
      </button>
    </form>
  );
}

function PersonFields({ person }: { person?: api.Person }) {
  return (
    <>
      <label>
        {t("person.name")}
        <input name="name" required maxLength={80} defaultValue={person?.name ?? ""} autofocus />
      </label>
      <label>
        {t("person.crew")}
        <input name="crew" maxLength={60} list={CREWS} defaultValue={person?.crew ?? ""} />
      </label>
      <label>
        {t("person.role")}
        <input name="role" maxLength={60} defaultValue={person?.role ?? ""} />
      </label>
    </>
  );
}

function PhotoField() {
  return (
    <label>
      {t("person.photo")}
      <input name="photo" type="file" accept="image/*" />
    </label>
  );
}

async function add(form: HTMLFormElement): Promise<void> {
  const data = new FormData(form);
  const person = await api.addPerson(written(data));
  form.reset(); // whatever becomes of the photo: pressed again, the form would add somebody twice
  await setPhoto(person, data);
}

/** True once all of it is done. */
async function change(person: api.Person, data: FormData): Promise<true> {
  await api.changePerson(person.person_id, written(data));
  await setPhoto(person, data);
  return true;
}

function written(data: FormData): { name: string; crew: string; role: string } {
  const text = (name: string) => String(data.get(name) ?? "").trim();
  return { name: text("name"), crew: text("crew"), role: text("role") };
}

async function setPhoto({ person_id }: api.Person, data: FormData): Promise<void> {
  const photo = data.get("photo");
  if (photo instanceof File && photo.size > 0) await api.setPhoto(person_id, photo);
}

function PersonForm({ done }: { done: () => void }) {
  const once = useSinglePress();
  return (
    <form
      class="row"
      onSubmit={(event) => {
        event.preventDefault();
        const form = event.currentTarget;
        once(() => attempt(add(form)).then(done));
      }}
    >
      <PersonFields />
      <PhotoField />
      <button class="primary">{t("person.add")}</button>
    </form>
  );
}
