import { useSignal, type Signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import type { AlarmWithLife } from "../answers";
import * as api from "../api";
import { t } from "../language/translate";
import { isOpen } from "../live/alarms";
import { ALL_ALARMS, filtered, type AlarmFilter } from "../live/alarmLives";
import type { Picture } from "../live/picture";
import { picture, replay } from "../sessions";
import { AlarmFilters } from "./AlarmFilters";
import { AlarmLife } from "./AlarmLife";
import { Dialog } from "./Dialog";
import { useLoaded } from "./useLoaded";
import { Waiting } from "./Waiting";

const WITHOUT_INCIDENT_MS = 86_400_000;
const LOOK_MS = 2_000;
const MOST_ROWS = 100;

/** Every alarm of the incident with its transitions, the newest first; in a replay, of the shown incident. */
export function AlarmsDialog() {
  const shown = picture.value;
  return shown === null ? null : <AlarmList picture={shown} />;
}

function AlarmList({ picture: shown }: { picture: Picture }) {
  const [loaded, again] = useLoaded(() => load(shown));
  useReloadOnChange(shown, again);
  const filter = useSignal<AlarmFilter>(ALL_ALARMS);
  const most = useSignal(MOST_ROWS);
  const all = loaded.value;
  const nowMs = shown.nowMs.value;
  const alarms = all === null ? [] : filtered(all, filter.value, nowMs);
  return (
    <Dialog title={t("alarm_list.title")} wide>
      {all === null ? (
        <Waiting />
      ) : (
        <AlarmFilters all={all} filter={filter} picture={shown} />
      )}
      {all !== null && <p role="status">{countText(all, alarms)}</p>}
      <ol class="alarm-lives" aria-label={t("alarm_list.newest_first")}>
        {alarms.slice(0, most.value).map((alarm) => (
          <AlarmLife key={alarm.alarm_id} alarm={alarm} picture={shown} sinceMs={beginMs(alarms)} />
        ))}
      </ol>
      {alarms.length > most.value && <More most={most} left={alarms.length - most.value} />}
    </Dialog>
  );
}

/** Of the incident that is shown; while none is open, of the last day. */
function load(shown: Picture): Promise<AlarmWithLife[]> {
  const past = replay.peek()?.incident.incident_id;
  const incident = shown.incident.peek();
  if (past !== undefined) return api.incidentAlarms(past);
  if (incident !== null && incident.closed_ms === null) {
    return api.incidentAlarms(incident.incident_id);
  }
  return api.alarms(Math.max(0, Math.floor(shown.nowMs.peek() - WITHOUT_INCIDENT_MS)));
}

/** Times of one day need no date. */
function beginMs(alarms: readonly AlarmWithLife[]): number {
  return alarms[0]?.raised_ms ?? 0;
}

/** Interval of requests while alarms change; in a replay they do not. */
function useReloadOnChange(shown: Picture, again: () => void): void {
  const seen = useRef(newestChangeMs(shown));
  useEffect(() => {
    if (shown.replay.peek() !== null) return undefined;
    const look = () => {
      const changedMs = newestChangeMs(shown);
      if (changedMs === seen.current) return;
      seen.current = changedMs;
      again();
    };
    const timer = setInterval(look, LOOK_MS);
    return () => clearInterval(timer);
  }, [shown]);
}

function newestChangeMs(shown: Picture): number {
  return [...shown.alarms.peek().values()].reduce((newest, { changed_ms }) => Math.max(newest, changed_ms), 0);
}

function countText(all: readonly AlarmWithLife[], shown: readonly AlarmWithLife[]): string {
  const open = shown.filter(isOpen).length;
  const counts = { shown: shown.length, open };
  if (shown.length === all.length) return t("alarm_list.count", counts);
  return t("alarm_list.count_of", { ...counts, all: all.length });
}

function More({ most, left }: { most: Signal<number>; left: number }) {
  return (
    <button type="button" onClick={() => (most.value += MOST_ROWS)}>
      {t("alarm_list.more", { count: left })}
    </button>
  );
}
