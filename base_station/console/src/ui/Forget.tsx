import { useSignal } from "@preact/signals";
import { attempt } from "../sessions";
import { notice } from "../view";
import type * as api from "../api";
import { fields } from "./useLoaded";

interface Props {
  name: string;
  warning: string;
  forget: (name: string) => Promise<api.Forgotten>;
  done: () => void;
}

/** Deletes what is stored, for good: whoever wants that writes the name. */
export function Forget({ name, warning, forget, done }: Props) {
  const asked = useSignal(false);
  const busy = useSignal(false);
  if (!asked.value) {
    return (
      <button type="button" aria-label={`Forget ${name}`} onClick={() => (asked.value = true)}>
        Forget
      </button>
    );
  }
  return (
    <form
      class="forget"
      onSubmit={(event) => {
        const { typed = "" } = fields(event);
        busy.value = true;
        void attempt(forget(typed)).then((gone) => {
          busy.value = false;
          if (gone === null) return;
          asked.value = false;
          notice.value = `${gone.records} records were taken out of the log.`;
          done();
        });
      }}
    >
      <p>{warning} It cannot be undone; the audit log keeps that it was done.</p>
      <label>
        Write “{name}” to go on
        <input name="typed" required autocomplete="off" />
      </label>
      <button class="danger" disabled={busy}>
        {busy.value ? "Deleting …" : "Forget for good"}
      </button>
      <button type="button" onClick={() => (asked.value = false)}>
        No
      </button>
    </form>
  );
}
