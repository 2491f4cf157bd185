import { attempt, user as me } from "../sessions";
import * as api from "../api";
import { Columns } from "./Columns";
import { ConfirmButton } from "./ConfirmButton";
import { Dialog } from "./Dialog";
import { useDone } from "./Done";
import { useChosen } from "./useChosen";
import { fields, useLoaded } from "./useLoaded";
import { Waiting } from "./Waiting";

/** Who may log in, and as what. */
export function UsersDialog() {
  const [users, again] = useLoaded(api.users);
  return (
    <Dialog title="Users" wide>
      <NewUser done={again} />
      <table class="stacked">
        <Columns names={["User", "Role", "New password", "Logged in"]} spoken="Remove" />
        <tbody>
          {(users.value ?? []).map((user) => (
            <UserRow key={user.username} user={user} done={again} />
          ))}
        </tbody>
      </table>
      {users.value === null && <Waiting />}
    </Dialog>
  );
}

function NewUser({ done }: { done: () => void }) {
  return (
    <form
      class="row"
      onSubmit={(event) => {
        const form = event.currentTarget;
        const { username = "", password = "", role = "viewer" } = fields(event);
        const added = api.addUser(username, password, role as api.Role);
        void attempt(added.then(() => form.reset())).then(done);
      }}
    >
      <label>
        Name
        <input name="username" required maxLength={80} autocomplete="off" />
      </label>
      <label>
        Password, at least 10 characters
        <input name="password" type="password" required minLength={10} autocomplete="new-password" />
      </label>
      <label>
        Role
        <select name="role">
          {api.ROLES.map((role) => (
            <option key={role}>{role}</option>
          ))}
        </select>
      </label>
      <button class="primary">Add user</button>
    </form>
  );
}

function UserRow({ user, done }: { user: api.User; done: () => void }) {
  const { username } = user;
  const role = useChosen(user.role, (chosen) => {
    void attempt(api.changeUser(username, { role: chosen as api.Role })).then(done);
  });
  const set = useDone("Set.");
  return (
    <tr>
      <th scope="row">
        {username}
        {username === me.value?.username && <small> (you)</small>}
      </th>
      <td data-label="Role">
        <select aria-label={`Role of ${username}`} {...role}>
          {api.ROLES.map((role) => (
            <option key={role}>{role}</option>
          ))}
        </select>
      </td>
      <td data-label="New password">
        <form
          class="inline"
          onInput={set.unsay}
          onSubmit={(event) => {
            const form = event.currentTarget;
            const { password = "" } = fields(event);
            const changed = api.changeUser(username, { password }).then(() => form.reset());
            void attempt(changed.then(set.say)).then(done);
          }}
        >
          <input
            name="password"
            type="password"
            required
            minLength={10}
            autocomplete="new-password"
            aria-label={`New password of ${username}`}
          />
          <button>Set</button>
          {set.words}
        </form>
      </td>
      <td data-label="Logged in">
        {user.sessions === 0 ? (
          "no"
        ) : (
          <ConfirmButton
            label={`End ${user.sessions} ${user.sessions === 1 ? "session" : "sessions"}`}
            question={`${username} has to log in again.`}
            onConfirm={() => void attempt(api.endSessions(username)).then(done)}
          />
        )}
      </td>
      <td>
        <ConfirmButton
          label="Remove"
          question={`${username} can never log in again.`}
          onConfirm={() => void attempt(api.removeUser(username)).then(done)}
        />
      </td>
    </tr>
  );
}
