import { attempt } from "../sessions";
import * as api from "../api";
import { Dialog } from "./Dialog";
import { Photo } from "./Photo";
import { useLoaded } from "./useLoaded";

export function PeopleDialog() {
  const [people, again] = useLoaded(api.people);
  return (
    <Dialog title="People">
      <PersonForm done={again} />
      <table>
        <thead>
          <tr>
            <th scope="col">Name</th>
            <th scope="col">Crew</th>
            <th scope="col">Role</th>
            <th scope="col">Photo</th>
          </tr>
        </thead>
        <tbody>
          {(people.value ?? []).map((person) => (
            <PersonRow key={person.person_id} person={person} done={again} />
          ))}
        </tbody>
      </table>
    </Dialog>
  );
}

function PersonRow({ person, done }: { person: api.Person; done: () => void }) {
  return (
    <tr>
      <th scope="row">
        <span class="person">
          <Photo name={person.name} url={person.photo_url} />
          {person.name}
        </span>
      </th>
      <td>{person.crew}</td>
      <td>{person.role}</td>
      <td>
        <input
          type="file"
          accept="image/*"
          aria-label={`New photo of ${person.name}`}
          onChange={(event) => {
            const photo = event.currentTarget.files?.[0];
            if (photo) void attempt(api.setPhoto(person.person_id, photo)).then(done);
          }}
        />
      </td>
    </tr>
  );
}

async function add(form: HTMLFormElement): Promise<void> {
  const data = new FormData(form);
  const text = (name: string) => String(data.get(name) ?? "").trim();
  const person = await api.addPerson({
    name: text("name"),
    crew: text("crew"),
    role: text("role"),
  });
  const photo = data.get("photo");
  if (photo instanceof File && photo.size > 0) await api.setPhoto(person.person_id, photo);
  form.reset();
}

function PersonForm({ done }: { done: () => void }) {
  return (
    <form
      class="row"
      onSubmit={(event) => {
        event.preventDefault();
        void attempt(add(event.currentTarget)).then(done);
      }}
    >
      <label>
        Name
        <input name="name" required maxLength={80} />
      </label>
      <label>
        Crew
        <input name="crew" maxLength={60} />
      </label>
      <label>
        Role
        <input name="role" maxLength={60} />
      </label>
      <label>
        Photo
        <input name="photo" type="file" accept="image/*" />
      </label>
      <button class="primary">Add person</button>
    </form>
  );
}
