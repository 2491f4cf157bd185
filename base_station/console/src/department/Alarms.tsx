import { age } from "../format";
import { knownLabel, label, t } from "../language/translate";
import { alarmText } from "../live/alarmText";
import type { DepartmentAlarmView, DepartmentView } from "./answers";
import { consoleUrl } from "./consoles";
import { ConsoleLink, Section } from "./Section";

const COLUMNS = ["since", "station", "who", "alarm", "state"] as const;
const GRAVEST = 1;

/** Open ones, the gravest and newest first. */
export function Alarms({ view }: { view: DepartmentView }) {
  return (
    <Section
      besideMap
      name="alarms"
      title={t("department.alarms", { count: view.open_alarms })}
      columns={COLUMNS.map((key) => t(`department.${key}`))}
      empty={t("department.no_alarms")}
      rows={view.alarms.map((alarm) => (
        <tr key={`${alarm.station} ${alarm.alarm_id}`}>
          <td>{age(view.now_ms - alarm.raised_ms)}</td>
          <td>
            <ConsoleLink text={alarm.station} url={consoleUrl(view, alarm.station)} />
          </td>
          <td>{alarm.person === "" ? alarm.unit_id : alarm.person}</td>
          <td class={alarm.priority === GRAVEST ? "bad" : "doubtful"}>
            {ruleLabel(alarm)} <span class="quiet">{alarmText(alarm)}</span>
          </td>
          <td>{stateText(alarm)}</td>
        </tr>
      ))}
    />
  );
}

function ruleLabel({ rule, level }: DepartmentAlarmView): string {
  return knownLabel("alarm_label", `${rule}/${level}`) ?? label("alarm_label", rule);
}

function stateText({ state, by }: DepartmentAlarmView): string {
  const name = label("department", state);
  return by === "" ? name : t("department.state_by", { state: name, by });
}
