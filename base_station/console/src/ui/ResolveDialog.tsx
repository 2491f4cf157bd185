import { t } from "../language/translate";
import { alarmText } from "../live/alarmText";
import { mayAct } from "../sessions";
import { dialog, resolving } from "../uiState";
import { Dialog } from "./Dialog";
import { ResolveForm } from "./ResolveForm";

/** Dialog for the reason of a resolution of one row's alarms, which is required. */
export function ResolveDialog() {
  const alarms = resolving.value;
  if (alarms.length === 0 || !mayAct.value) return null;
  const count = alarms.length;
  const title = count === 1 ? t("alarm_list.resolve_one") : t("alarm_list.resolve_many", { count });
  return (
    <Dialog title={title}>
      <ul class="resolved-here">
        {alarms.map((alarm) => (
          <li key={alarm.alarm_id}>{alarmText(alarm)}</li>
        ))}
      </ul>
      <ResolveForm alarms={alarms} done={() => (dialog.value = null)} />
    </Dialog>
  );
}
