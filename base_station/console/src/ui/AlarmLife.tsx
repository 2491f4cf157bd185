import { useSignal } from "@preact/signals";
import type { AlarmHistoryEntry, AlarmWithLife } from "../answers";
import * as api from "../api";
import { timeSince } from "../format";
import { t } from "../language/translate";
import { isOpen } from "../live/alarms";
import { byWords, changeWord, peakText } from "../live/alarmLives";
import { alarmText, type AlarmSentence } from "../live/alarmText";
import type { Picture } from "../live/picture";
import { LEAD_MS, within } from "../live/replaying";
import { attempt, mayAct, replay, steer } from "../sessions";
import { dialog } from "../uiState";
import type { AlarmView } from "../wire";
import { priorityWord } from "./AlarmRow";
import { Icon } from "./Icon";
import { ResolveForm } from "./ResolveForm";
import { showUnit } from "./showIncident";

type ShownAlarm = api.SeenAlarm & AlarmSentence & Pick<AlarmView, "state">;

interface Props {
  alarm: AlarmWithLife;
  picture: Picture;
  sinceMs: number; // times of its day are shown without the date
}

/** One alarm of the list: its raising and transitions, with user, reason and time. */
export function AlarmLife({ alarm, picture, sinceMs }: Props) {
  const shown: ShownAlarm = picture.alarms.value.get(alarm.alarm_id) ?? alarm;
  const peak = peakText(alarm);
  const unit = picture.unit(alarm.unit_id);
  const show = () => {
    dialog.value = null;
    showUnit(picture, alarm.unit_id);
  };
  return (
    <li class={`alarm-life p${alarm.priority} ${alarm.state}`}>
      <h3>
        <Icon name={alarm.state === "raised" ? "alarm" : "check"} />
        <span class="priority">{priorityWord(alarm.priority)}</span>{" "}
        {alarmText(alarm.changes[0] ?? alarm)}
      </h3>
      <ol class="changes">
        {alarm.changes.map((change, at) => (
          <Change
            key={`${change.t_ms} ${change.state} ${change.level}`}
            change={change}
            word={changeWord(alarm.changes, at)}
            sinceMs={sinceMs}
          />
        ))}
      </ol>
      {peak !== "" && (
        <p class="peak">
          {t(isOpen(alarm) ? "alarm_list.peak_so_far" : "alarm_list.peak", { value: peak })}
        </p>
      )}
      <div class="row-actions">
        {unit !== undefined && (
          <button type="button" aria-label={about("on_plan", alarm)} onClick={show}>
            {t("alarm_list.on_plan")}
          </button>
        )}
        {mayAct.value && isOpen(shown) && <Actions alarm={shown} />}
      </div>
    </li>
  );
}

interface ChangeProps {
  change: AlarmHistoryEntry;
  word: string;
  sinceMs: number;
}

function Change({ change, word, sinceMs }: ChangeProps) {
  const by = byWords(change);
  return (
    <li>
      <Moment atMs={change.t_ms} sinceMs={sinceMs} /> <strong>{word}</strong>
      {by !== "" && ` (${by})`}
    </li>
  );
}

/** In a replay it seeks to the alarm, with a short lead. */
function Moment({ atMs, sinceMs }: { atMs: number; sinceMs: number }) {
  const words = timeSince(sinceMs, atMs);
  const watched = replay.value;
  const state = watched?.session.picture.replay.value ?? null;
  if (watched === null || state === null) return <time>{words}</time>;
  const goMs = Math.round(within(atMs - LEAD_MS, state.start_ms, state.end_ms));
  return (
    <button type="button" class="moment-link" onClick={() => steer(watched, { at_ms: goMs })}>
      {words}
    </button>
  );
}

function Actions({ alarm }: { alarm: ShownAlarm }) {
  const asked = useSignal(false);
  if (asked.value) {
    return (
      <>
        <button type="button" onClick={() => (asked.value = false)}>
          {t("alarm_list.not_yet")}
        </button>
        <ResolveForm alarms={[alarm]} done={() => (asked.value = false)} />
      </>
    );
  }
  return (
    <>
      {alarm.state === "raised" && (
        <button
          type="button"
          aria-label={about("acknowledge", alarm)}
          onClick={() => void attempt(api.acknowledge(alarm))}
        >
          {t("alarm_list.acknowledge")}
        </button>
      )}
      <button type="button" aria-label={about("resolve", alarm)} onClick={() => (asked.value = true)}>
        {t("alarm_list.resolve")}
      </button>
    </>
  );
}

/** Distinguishes buttons with the same text by their alarm. */
function about(act: "on_plan" | "acknowledge" | "resolve", alarm: AlarmSentence): string {
  return t("alarm_list.about", { act: t(`alarm_list.${act}`), alarm: alarmText(alarm) });
}
