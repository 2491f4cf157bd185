import { useSignal } from "@preact/signals";
import type { ResolutionReason } from "../answers";
import * as api from "../api";
import { label, t } from "../language/translate";
import { REASONS } from "../live/alarmLives";
import { inTurn } from "./inTurn";
import { useGuardedPress } from "./useGuardedPress";

const MOST_LETTERS = 500; // as the station takes them

interface Props {
  alarms: readonly api.SeenAlarm[];
  done: () => void;
}

/** Reason of a resolution: one press on it resolves these alarms, with the note if there is one. */
export function ResolveForm({ alarms, done }: Props) {
  const note = useSignal("");
  const steady = useGuardedPress("reasons");
  const resolve = (reason: ResolutionReason) => {
    const resolution = { reason, note: note.peek().trim() };
    void inTurn(alarms, (alarm) => api.resolve(alarm, resolution)).then((all) => all && done());
  };
  return (
    <div class="resolve-form">
      <label class="long">
        {t("alarm_list.note")}
        <input
          maxLength={MOST_LETTERS}
          value={note.value}
          onInput={({ currentTarget }) => (note.value = currentTarget.value)}
        />
      </label>
      <div class="reasons" role="group" aria-label={t("alarm_list.why")}>
        {REASONS.map((reason) => (
          <button
            key={reason}
            type="button"
            disabled={reason === "other" && note.value.trim() === ""}
            onClick={steady(() => resolve(reason))}
          >
            {label("alarm_reason", reason)}
          </button>
        ))}
      </div>
      <p class="quiet">{t("alarm_list.hint")}</p>
    </div>
  );
}
