import { t } from "../language/translate";
import { alarmText } from "../live/alarmText";
import { isPast, live, stopReplay } from "../sessions";
import { dialog } from "../uiState";
import { Icon } from "./Icon";
import { showUnit } from "./showIncident";

/** In a dialog, which covers the alarms: urgent unacknowledged alarms.  Over a replay they are live ones,
 * and lead there; past alarms are not shown. */
export function UrgentNow() {
  const overPast = isPast.value;
  const watched = live.value?.picture;
  const picture = watched?.replay.value === null ? watched : undefined;
  const urgent = (picture?.openAlarms.value ?? []).filter(
    (alarm) => alarm.priority === 1 && alarm.state === "raised",
  );
  const [first, ...more] = urgent;
  if (picture === undefined || first === undefined) return <div role="alert" />;
  const other = picture.otherIncidentOf(first.unit_id);
  const show = () => {
    stopReplay();
    dialog.value = null;
    showUnit(picture, first.unit_id);
  };
  const words = other === null ? alarmText(first) : `${other.name}: ${alarmText(first)}`;
  return (
    <div role="alert" class="urgent-now">
      <button type="button" onClick={show}>
        <Icon name="alarm" />
        {overPast ? t("alarm_now.live", { text: words }) : words}
        {more.length > 0 && ` (+${more.length})`}
      </button>
    </div>
  );
}
