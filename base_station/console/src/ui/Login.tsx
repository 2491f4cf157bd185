import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { notice } from "../uiState";
import * as api from "../api";
import { isUnanswered } from "../http";
import { arrivalNotice } from "../live/loginTransfer";
import { t } from "../language/translate";

/** Name and password, and a new password first if the station has generated it. `enter` is called with
 * the logged-in user. */
export function Login({ enter }: { enter: (me: api.Me) => void }) {
  const problem = useSignal("");
  const busy = useSignal(false);
  const generated = useSignal<string | null>(null); // the password that has to be changed
  const originSentence = arrivalNotice(location.hash);

  async function submit(event: SubmitEvent) {
    event.preventDefault();
    const form = new FormData(event.currentTarget as HTMLFormElement);
    if (form.get("fresh") !== form.get("again")) {
      problem.value = t("login.not_the_same");
      return;
    }
    busy.value = true;
    try {
      const me = await (generated.value === null ? logIn(form) : change(form, generated.value));
      problem.value = "";
      if (me !== null) {
        enter(me);
        notice.value = null;
      }
    } catch (error) {
      problem.value = isUnanswered(error) ? t("connection.unreachable") : String((error as Error).message);
    }
    busy.value = false;
  }

  /** Null: the password has to be changed first. */
  async function logIn(form: FormData): Promise<api.Me | null> {
    const password = String(form.get("password"));
    const me = await api.login(String(form.get("username")), password);
    if (!me.must_change_password) return me;
    generated.value = password;
    return null;
  }

  async function change(form: FormData, old: string): Promise<api.Me | null> {
    await api.changeOwnPassword(old, String(form.get("fresh")));
    return api.me();
  }

  return (
    <main class="login">
      <form onSubmit={submit} aria-labelledby="login-title">
        <img src="/icon.svg" alt="" width="48" height="48" />
        <h1 id="login-title">Muster</h1>
        {originSentence !== "" && <p role="status">{originSentence}</p>}
        {notice.value !== null && <p role="status">{notice.value}</p>}
        {generated.value === null ? <Credentials /> : <NewPassword />}
        <button class="primary" disabled={busy}>
          {t(generated.value === null ? "login.log_in" : "account.change_password")}
        </button>
        <p class="problem" role="alert">
          {problem}
        </p>
        <p class="quiet">{t("frame.pass_device")}</p>
      </form>
    </main>
  );
}

function Credentials() {
  const name = useRef<HTMLInputElement>(null);
  useEffect(() => name.current?.focus(), []);
  return (
    <>
      <label>
        {t("login.user")}
        <input name="username" autocomplete="username" required ref={name} />
      </label>
      <label>
        {t("account.password")}
        <input name="password" type="password" autocomplete="current-password" required />
      </label>
    </>
  );
}

function NewPassword() {
  const fresh = useRef<HTMLInputElement>(null);
  useEffect(() => fresh.current?.focus(), []);
  const field = { type: "password", autocomplete: "new-password", required: true, minLength: 10 } as const;
  return (
    <>
      <p role="status">
        {t("login.generated")}
      </p>
      <label>
        {t("account.new_password")}
        <input name="fresh" ref={fresh} {...field} />
      </label>
      <label>
        {t("login.again")}
        <input name="again" {...field} />
      </label>
    </>
  );
}
