/** Open alarms as the rows of the alarm zone: one for each member, and one for a flood of alike alarms.
 * Pure. */
import type { AlarmView } from "../wire";
import { alarmLabel, MISSED_CHECK_IN, SWITCHED_OFF } from "../format";
import { clock, listed } from "../language/measures";
import { t } from "../language/translate";

export interface AlarmRow {
  key: string;
  alarms: readonly AlarmView[]; // as they are listed, the most urgent first; at least one
  isFlood: boolean; // of many units, not of one
}

/** So many alike alarms of different units are one row. */
const FLOOD_UNITS = 5;
/** Raised within this of one another they have one cause. */
const FLOOD_GAP_MS = 30_000;

/** One row for each alarm. */
export function singleRows(open: readonly AlarmView[]): AlarmRow[] {
  return open.map((alarm) => ({ key: alarm.alarm_id, alarms: [alarm], isFlood: false }));
}

/** Rows of `open` by urgency: a row has the place of its first alarm.  A casualty keeps all alarms in the
 * own row, and a flood is of one incident. */
export function alarmRows(
  open: readonly AlarmView[],
  incidentOf: (unitId: string) => string = () => "",
): AlarmRow[] {
  const down = new Set(open.filter(isOfDown).map((alarm) => alarm.unit_id));
  const others = open.filter((alarm) => alarm.unit_id !== "" && !down.has(alarm.unit_id));
  const floods = floodsOf(others, incidentOf);
  const rows = new Map<string, { isFlood: boolean; alarms: AlarmView[] }>();
  for (const alarm of open) {
    const flood = floods.get(alarm.alarm_id);
    const key = flood ?? (alarm.unit_id === "" ? alarm.alarm_id : `unit ${alarm.unit_id}`);
    const row = rows.get(key) ?? { isFlood: flood !== undefined, alarms: [] };
    row.alarms.push(alarm);
    rows.set(key, row);
  }
  return [...rows].map(([key, row]) => ({ key, ...row }));
}

function isOfDown({ priority, rule, unit_id }: AlarmView): boolean {
  return priority === 1 && rule !== MISSED_CHECK_IN && unit_id !== "";
}

/** The key of the flood by the id of each alarm that belongs to one. */
function floodsOf(
  alarms: readonly AlarmView[],
  incidentOf: (unitId: string) => string,
): Map<string, string> {
  const alike = new Map<string, AlarmView[]>();
  for (const alarm of alarms) {
    const kind = `${alarm.rule} ${alarm.level} ${alarm.priority} ${incidentOf(alarm.unit_id)}`;
    alike.set(kind, [...(alike.get(kind) ?? []), alarm]);
  }
  const floods = new Map<string, string>();
  for (const [kind, of] of alike) {
    for (const flood of together(of).filter(isFlood)) {
      const key = `flood ${kind} ${flood[0]?.raised_ms}`;
      for (const { alarm_id } of flood) floods.set(alarm_id, key);
    }
  }
  return floods;
}

/** Those raised shortly after one another, by time. */
function together(alarms: readonly AlarmView[]): AlarmView[][] {
  const groups: AlarmView[][] = [];
  let lastMs = -Infinity;
  for (const alarm of [...alarms].sort((a, b) => a.raised_ms - b.raised_ms)) {
    if (alarm.raised_ms - lastMs > FLOOD_GAP_MS) groups.push([]);
    groups.at(-1)?.push(alarm);
    lastMs = alarm.raised_ms;
  }
  return groups;
}

function isFlood(alarms: readonly AlarmView[]): boolean {
  return new Set(alarms.map((alarm) => alarm.unit_id)).size >= FLOOD_UNITS;
}

/** "200 units lost their link at 14:02", or "from 14:02 to 14:05". */
export function floodText({ alarms }: AlarmRow): string {
  const [first] = alarms;
  if (first === undefined) return "";
  const times = alarms.map((alarm) => alarm.raised_ms);
  const [from, to] = [clock(Math.min(...times), false), clock(Math.max(...times), false)];
  const what = whatHappened(first, alarms.length);
  return from === to ? t("alarm.flood_at", { what, time: from }) : t("alarm.flood_from", { what, from, to });
}

function whatHappened(alarm: AlarmView, count: number): string {
  if (alarm.rule === MISSED_CHECK_IN) return t("alarm.flood_par", { count });
  if (alarm.level === SWITCHED_OFF) return t("alarm.flood_off", { count });
  if (alarm.rule === "link-lost") return t("alarm.flood_link", { count });
  return t("alarm.flood_other", { count, alarm: alarmLabel(alarm) });
}

/** Unacknowledged alarms. */
export function raisedOf({ alarms }: AlarmRow): AlarmView[] {
  return alarms.filter((alarm) => alarm.state === "raised");
}

/** Users who acknowledged them, each once: "mia, chief". */
export function takenBy({ alarms }: AlarmRow): string {
  return listed([...new Set(alarms.map((alarm) => alarm.by))]);
}
