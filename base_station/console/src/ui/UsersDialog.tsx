import { attempt, user as me } from "../sessions";
import * as api from "../api";
import { t } from "../language/translate";
import { Columns } from "./Columns";
import { ConfirmButton } from "./ConfirmButton";
import { Dialog } from "./Dialog";
import { useDone } from "./Done";
import { useChosen } from "./useChosen";
import { fields, useLoaded } from "./useLoaded";
import { Waiting } from "./Waiting";

/** Users and their roles. */
export function UsersDialog() {
  const [users, again] = useLoaded(api.users);
  return (
    <Dialog title={t("users.title")} wide>
      <NewUser done={again} />
      <table class="stacked">
        <Columns names={[t("users.user"), t("users.role"), t("users.new_password"), t("users.logged_in")]} spoken={t("users.remove")} />
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
        {t("users.name")}
        <input name="username" required maxLength={80} autocomplete="off" />
      </label>
      <label>
        {t("users.password")}
        <input name="password" type="password" required minLength={10} autocomplete="new-password" />
      </label>
      <label>
        {t("users.role")}
        <select name="role">
          {api.ROLES.map((role) => (
            <option key={role} value={role}>
              {t(`role.${role}`)}
            </option>
          ))}
        </select>
      </label>
      <button class="primary">{t("users.add")}</button>
    </form>
  );
}

function UserRow({ user, done }: { user: api.User; done: () => void }) {
  const { username } = user;
  const role = useChosen(user.role, (chosen) => {
    void attempt(api.changeUser(username, { role: chosen as api.Role })).then(done);
  });
  const set = useDone(t("users.done"));
  return (
    <tr>
      <th scope="row">
        {username}
        {username === me.value?.username && <small> {t("users.you")}</small>}
      </th>
      <td data-label={t("users.role")}>
        <select aria-label={t("users.role_of", { name: username })} {...role}>
          {api.ROLES.map((role) => (
            <option key={role} value={role}>
              {t(`role.${role}`)}
            </option>
          ))}
        </select>
      </td>
      <td data-label={t("users.new_password")}>
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
            aria-label={t("users.new_password_of", { name: username })}
          />
          <button>{t("users.set")}</button>
          {set.words}
        </form>
      </td>
      <td data-label={t("users.logged_in")}>
        {user.sessions === 0 ? (
          t("users.no")
        ) : (
          <ConfirmButton
            label={t("users.end", { count: user.sessions })}
            question={t("users.end_question", { name: username })}
            onConfirm={() => void attempt(api.endSessions(username)).then(done)}
          />
        )}
      </td>
      <td>
        <ConfirmButton
          label={t("users.remove")}
          question={t("users.remove_question", { name: username })}
          onConfirm={() => void attempt(api.removeUser(username)).then(done)}
        />
      </td>
    </tr>
  );
}
