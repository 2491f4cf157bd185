import { useSignal } from "@preact/signals";
import { attempt, leave, user } from "../sessions";
import { confirmDone, openDialog } from "../uiState";
import * as api from "../api";
import { dateAndTime } from "../format";
import { listed } from "../language/measures";
import { label, rich, t } from "../language/translate";
import { Columns } from "./Columns";
import { ConfirmButton } from "./ConfirmButton";
import { Dialog } from "./Dialog";
import { fields, useLoaded } from "./useLoaded";

/** One's own password and tokens; for an administrator the way to the users and the audit log. */
export function AccountDialog() {
  const me = user.value;
  if (me === null) return null;
  return (
    <Dialog title={t("account.title", { name: me.username, role: label("role", me.role) })}>
      <p class="row">
        {me.role === "administrator" && (
          <>
            <button type="button" onClick={() => openDialog("users")}>
              {t("account.users")}
            </button>
            <button type="button" onClick={() => openDialog("audit")}>
              {t("audit.title")}
            </button>
          </>
        )}
        <button type="button" onClick={() => void leave()}>
          {t("account.log_out")}
        </button>
      </p>
      <h3>{t("account.password")}</h3>
      <PasswordForm username={me.username} />
      <details>
        <summary>{t("token.title")}</summary>
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
          confirmDone(t("account.password_changed"));
        });
        void attempt(changed);
      }}
    >
      <input name="username" autocomplete="username" value={username} readOnly hidden />
      <label>
        {t("account.old_password")}
        <input name="old" type="password" required autocomplete="current-password" />
      </label>
      <label>
        {t("account.new_password")}
        <input name="fresh" type="password" required minLength={10} autocomplete="new-password" />
      </label>
      <button class="primary">{t("account.change_password")}</button>
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
          {t("token.name")}
          <input name="name" required maxLength={80} />
        </label>
        <label>
          {t("token.role")}
          <select name="role">
            {api.ROLES.slice(0, api.ROLES.indexOf(role) + 1).map((one) => (
              <option key={one} value={one}>
                {label("role", one)}
              </option>
            ))}
          </select>
        </label>
        <label>
          {t("token.days")}
          <input name="days" type="number" min={1} max={3660} />
        </label>
        <label>
          {t("token.scopes")}
          <select name="scopes" multiple size={4}>
            {api.SCOPES.map((scope) => (
              <option key={scope} value={scope}>
                {label("scope", scope)}
              </option>
            ))}
          </select>
        </label>
        <button class="primary">{t("token.make")}</button>
      </form>
      {made.value !== null && (
        <p class="made" role="status">
          {rich("token.made", { token: <code>{made.value}</code> })}
        </p>
      )}
      <table class="stacked">
        <Columns names={[t("token.token"), t("token.may"), t("token.valid_until")]} spoken={t("common.remove")} />
        <tbody>
          {(tokens.value ?? []).map((token) => (
            <tr key={token.token_id}>
              <th scope="row">{token.name}</th>
              <td data-label={t("token.may")}>
                {label("role", token.role)},{" "}
                {token.scopes.length === 0
                  ? t("token.all_parts")
                  : listed(token.scopes.map((scope) => label("scope", scope)))}
              </td>
              <td data-label={t("token.valid_until")}>
                {token.expires_ms === null ? t("token.always") : dateAndTime(token.expires_ms)}
              </td>
              <td>
                <ConfirmButton
                  label={t("common.remove")}
                  question={t("token.remove_question")}
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
