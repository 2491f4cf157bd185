import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { begin } from "../sessions";
import { notice } from "../view";
import * as api from "../api";
import { isUnanswered, UNREACHABLE } from "../call";
import { arrival } from "../live/arrival";

export function Login() {
  const problem = useSignal("");
  const busy = useSignal(false);
  const cameFrom = arrival(location.hash);
  const name = useRef<HTMLInputElement>(null);
  useEffect(() => name.current?.focus(), []);

  async function submit(event: SubmitEvent) {
    event.preventDefault();
    const form = new FormData(event.currentTarget as HTMLFormElement);
    busy.value = true;
    try {
      begin(await api.login(String(form.get("username")), String(form.get("password"))));
      notice.value = null;
    } catch (error) {
      problem.value = isUnanswered(error) ? UNREACHABLE : String((error as Error).message);
    }
    busy.value = false;
  }

  return (
    <main class="login">
      <form onSubmit={submit} aria-labelledby="login-title">
        <img src="/icon.svg" alt="" width="48" height="48" />
        <h1 id="login-title">Muster</h1>
        {cameFrom !== "" && <p role="status">{cameFrom}</p>}
        {notice.value !== null && <p role="status">{notice.value}</p>}
        <label>
          User
          <input name="username" autocomplete="username" required ref={name} />
        </label>
        <label>
          Password
          <input name="password" type="password" autocomplete="current-password" required />
        </label>
        <button class="primary" disabled={busy}>
          Log in
        </button>
        <p class="problem" role="alert">
          {problem}
        </p>
        <p class="quiet">Muster supplements a certified PASS device and never replaces it.</p>
      </form>
    </main>
  );
}
