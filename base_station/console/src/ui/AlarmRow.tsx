import { useEffect, useRef } from "preact/hooks";
import { mayAct } from "../sessions";
import { openResolve } from "../uiState";
import * as api from "../api";
import { handedTo, sinceMs } from "../live/alarms";
import { alarmCurrentValue } from "../live/alarmCurrentValue";
import { alarmText } from "../live/alarmText";
import { floodText, raisedOf, takenBy, type AlarmRow } from "../live/alarmRows";
import type { Picture } from "../live/picture";
import type { AlarmView } from "../wire";
import { alarmLabel, duration, MISSED_CHECK_IN } from "../format";
import { type PlainKey, t } from "../language/translate";
import { showUnit } from "./showIncident";
import { useGuardedPress } from "./useGuardedPress";
import { Icon } from "./Icon";
import { inTurn } from "./inTurn";

const PRIORITY: Record<number, PlainKey> = { 1: "alarm.emergency", 2: "alarm.warning", 3: "alarm.advisory" };

interface Props {
  row: AlarmRow;
  place: number; // in the list
  picture: Picture;
  /** Of a flood, the alarms are listed. */
  onFlood: () => void;
}

/** The alarms of one member, or of a flood: kind, time, and acknowledging user. */
export function AlarmRowView({ row, place, picture, onFlood }: Props) {
  const [first] = row.alarms;
  if (first === undefined) return null;
  const taken = raisedOf(row).length === 0;
  const unit = picture.unit(first.unit_id);
  const words = spoken(row, picture);
  const show = () => showUnit(picture, first.unit_id);
  return (
    <li class={`alarm p${first.priority} ${taken ? "taken" : ""}`} data-alarm={first.alarm_id}>
      <Icon name={taken ? "check" : "alarm"} />
      <span class="priority">{priorityWord(first.priority)}</span>
      <button
        type="button"
        class="what"
        title={t("common.hint", {
          what: words,
          action: t(row.isFlood ? "alarm.list" : "common.show_on_plan"),
        })}
        disabled={!row.isFlood && unit === undefined}
        onClick={row.isFlood ? onFlood : show}
      >
        {headOf(row, first, picture)}
        {!row.isFlood &&
          row.alarms.slice(1).map((alarm) => (
            <span class="cause" key={alarm.alarm_id}>
              {" "}
              + {alarmLabel(alarm)}
              <span aria-live="off">{figureBehind(alarm, picture)}</span>
            </span>
          ))}
      </button>
      <span class="since" aria-live="off">
        {t("measure.ago", { age: duration(picture.nowMs.value - sinceMs(first)) })}{" "}
        {!row.isFlood && <Figure alarm={first} picture={picture} />}
      </span>
      <State words={stateOf(row, taken, mayAct.value)} />
      {mayAct.value && <Action row={row} place={place} words={words} />}
    </li>
  );
}

/** Title of a row; for another incident than the shown one, with its name. */
function headOf(row: AlarmRow, first: AlarmView, picture: Picture): string {
  const other = picture.otherIncidentOf(first.unit_id);
  const words = row.isFlood ? floodText(row) : textOf(first, picture);
  return other === null ? words : t("alarm.of_incident", { incident: other.name, text: words });
}

export function priorityWord(priority: number): string {
  const key = PRIORITY[priority];
  return key === undefined ? t("alarm.priority", { number: priority }) : t(key);
}

function textOf(alarm: AlarmView, picture: Picture): string {
  const unit = picture.unit(alarm.unit_id);
  const handed = unit === undefined ? "" : handedTo(alarm, unit.value);
  const text = alarmText(alarm);
  return handed === "" ? text : `${text} (${handed})`;
}

/** All of it in one sentence, without figures that change. */
function spoken(row: AlarmRow, picture: Picture): string {
  const [first, ...others] = row.alarms;
  if (first === undefined) return "";
  const head = headOf(row, first, picture);
  return row.isFlood ? head : [head, ...others.map(alarmLabel)].join(", ");
}

function figureOf(alarm: AlarmView, picture: Picture): string {
  const unit = picture.unit(alarm.unit_id);
  if (unit === undefined) return "";
  return alarmCurrentValue(alarm, unit.value, picture.nowMs.value, picture.silentMs.value > 0);
}

/** Without that of a PAR: it counts from the last confirmation, and behind "overdue" it would say for how
 * long the PAR is. */
function figureBehind(alarm: AlarmView, picture: Picture): string {
  if (alarm.rule === MISSED_CHECK_IN) return "";
  const figure = figureOf(alarm, picture);
  return figure === "" ? "" : `, ${figure}`;
}

function Figure({ alarm, picture }: { alarm: AlarmView; picture: Picture }) {
  const figure = figureOf(alarm, picture);
  return figure === "" ? null : <strong>{figure}</strong>;
}

/** A long name is truncated; its tooltip has the full name. */
function State({ words }: { words: string }) {
  return (
    <span class="state" title={words}>
      {words}
    </span>
  );
}

/** Empty beside a button to acknowledge, which shows that it is unacknowledged. */
function stateOf(row: AlarmRow, taken: boolean, hasButton: boolean): string {
  if (taken) return t("alarm.acknowledged_by", { who: takenBy(row) });
  return hasButton ? "" : t("alarm.not_acknowledged");
}

type ActionProps = Pick<Props, "row" | "place"> & { words: string };

/** One press acknowledges all raised alarms of the row.  Resolving asks for the reason first, as its
 * button replaces that to acknowledge.  The alarms of a flood are resolved one by one, as listed. */
function Action({ row, place, words }: ActionProps) {
  const ids = row.isFlood ? "" : row.alarms.map((alarm) => alarm.alarm_id).join(" ");
  const steady = useGuardedPress(`${place} ${ids}`);
  const pressed = useRef(false);
  const raised = raisedOf(row);
  if (raised.length > 0) {
    return (
      <button
        type="button"
        class="act"
        aria-label={t("common.about", { action: t("alarm.acknowledge"), what: words })}
        onClick={steady(() => {
          pressed.current = true;
          void inTurn(raised, api.acknowledge);
        })}
      >
        {t("alarm.acknowledge")}
      </button>
    );
  }
  if (row.isFlood) return null;
  return <Resolve alarms={row.alarms} words={words} focused={pressed.current} steady={steady} />;
}

interface ResolveProps {
  alarms: readonly AlarmView[];
  words: string;
  focused: boolean; // to begin with: it comes in place of what was pressed
  steady: ReturnType<typeof useGuardedPress>;
}

function Resolve({ alarms, words, focused, steady }: ResolveProps) {
  const button = useRef<HTMLButtonElement>(null);
  useEffect(() => {
    if (focused && document.activeElement === document.body) button.current?.focus();
  }, []);
  return (
    <button
      type="button"
      class="act"
      ref={button}
      aria-label={t("alarm_list.about", { act: t("alarm.resolve"), alarm: words })}
      onClick={steady(() => openResolve(alarms))}
    >
      {t("alarm_list.resolve")}
    </button>
  );
}
