import { useSignal } from "@preact/signals";
import { attempt, leave, user } from "../sessions";
import { notice, openDialog } from "../uiState";
import * as api from "../api";
import { dateAndTime } from "../format";
import { Columns } from "./Columns";
import { ConfirmButton } from "./ConfirmButton";
import { Dialog } from "./Dialog";
import { fields, useLoaded } from "./useLoaded";

/** One's own password and tokens; for an administrator the way to the users and the audit log. */
export function AccountDialog() {
  const me = user.value;
  if (me === null) return null;
  return (
    <Dialog title={`${me.username}, ${me.role}`}>
      <p class="row">
        {me.role === "administrator" && (
          <>
            <button type="button" onClick={() => openDialog("users")}>
              Users
            </button>
            <button type="button" onClick={() => openDialog("audit")}>
              Audit log
            </button>
          </>
        )}
        <button type="button" class="primary" onClick={() => void leave()}>
          Log out
        </button>
      </p>
      <h3>Password</h3>
      <PasswordForm username={me.username} />
      <details>
        <summary>Tokens for programs</summary>
        <Tokens role={me.role} />
      </details>
    </Dialog>
  );
}

function PasswordForm({ username }: { username: string }) {
  return (
    <form
      class="row"
      onSubmit={(event) => {
        const { old = "", fresh = "" } = fields(event);
        const changed = api.changeOwnPassword(old, fresh).then(async () => {
          await leave(); // its sessions have ended
          notice.value = "The password is changed. Log in with the new one.";
        });
        void attempt(changed);
      }}
    >
      <input name="username" autocomplete="username" value={username} readOnly hidden />
      <label>
        Old password
        <input name="old" type="password" required autocomplete="current-password" />
      </label>
      <label>
        New password, at least 10 characters
        <input name="fresh" type="password" required minLength={10} autocomplete="new-password" />
      </label>
      <button class="primary">Change password</button>
    </form>
  );
}

function Tokens({ role }: { role: api.Role }) {
  const [tokens, again] = useLoaded(api.tokens);
  const made = useSignal<string | null>(null);
  return (
    <>
      <form
        class="row"
        onSubmit={(event) => {
          const form = event.currentTarget;
          const scopes = new FormData(form).getAll("scopes").map(String);
          const { name = "", role: chosen = "viewer", days = "" } = fields(event);
          // The form offers no other roles and scopes.
          const wanted = {
            name,
            role: chosen,
            scopes,
            days: days === "" ? null : Number(days),
          } as api.NewToken;
          void attempt(api.addToken(wanted)).then((token) => {
            if (token === null) return;
            made.value = token.token;
            form.reset();
            again();
          });
        }}
      >
        <label>
          What it is for
          <input name="name" required maxLength={80} />
        </label>
        <label>
          May do what
          <select name="role">
            {api.ROLES.slice(0, api.ROLES.indexOf(role) + 1).map((one) => (
              <option key={one}>{one}</option>
            ))}
          </select>
        </label>
        <label>
          Days it is valid (empty: always)
          <input name="days" type="number" min={1} max={3660} />
        </label>
        <label>
          Parts of the station (none chosen: all)
          <select name="scopes" multiple size={4}>
            {api.SCOPES.map((scope) => (
              <option key={scope}>{scope}</option>
            ))}
          </select>
        </label>
        <button class="primary">Make token</button>
      </form>
      {made.value !== null && (
        <p class="made" role="status">
          Copy it now, it is not shown again: <code>{made.value}</code>
        </p>
      )}
      <table class="stacked">
        <Columns names={["Token", "May", "Valid until"]} spoken="Remove" />
        <tbody>
          {(tokens.value ?? []).map((token) => (
            <tr key={token.token_id}>
              <th scope="row">{token.name}</th>
              <td data-label="May">
                {token.role}, {token.scopes.length === 0 ? "all parts" : token.scopes.join(", ")}
              </td>
              <td data-label="Valid until">{token.expires_ms === null ? "always" : dateAndTime(token.expires_ms)}</td>
              <td>
                <ConfirmButton
                  label="Remove"
                  question="Programs that use it are shut out."
                  onConfirm={() => void attempt(api.removeToken(token.token_id)).then(again)}
                />
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </>
  );
}
