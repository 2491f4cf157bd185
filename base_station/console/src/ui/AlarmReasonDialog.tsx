import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import type { AlarmExplanationAnswer } from "../answers";
import * as api from "../api";
import { alarmLabel } from "../format";
import { displayName } from "../live/urgency";
import { alarmText } from "../live/alarmText";
import { attempt, picture } from "../sessions";
import { crossingText, thresholdsText } from "../timeline/explanation";
import { dialogUnit } from "../uiState";
import type { AlarmView } from "../wire";
import { t } from "../language/translate";
import { Dialog } from "./Dialog";
import { HearAlarm } from "./HearAlarm";
import { UnitTimeline } from "./TimelineDialog";

const ABOUT_MS = 60_000; // before and after

/** Of each open alarm of one member: the threshold that was crossed, and the values about that time. */
export function AlarmReasonDialog() {
  const unitId = dialogUnit.value;
  const unit = unitId === null ? undefined : picture.value?.unit(unitId)?.peek();
  const all = picture.value?.alarms.peek();
  if (unitId === null || unit === undefined || all === undefined) return null;
  const open = unit.alarms.map((id) => all.get(id)).filter((alarm) => alarm !== undefined);
  return (
    <Dialog title={t("alarm.of_member", { name: displayName(unit) })} wide>
      {open.length === 0 && <p class="quiet">{t("alarm.none_open_of_member")}</p>}
      {open.map((alarm) => (
        <Reason key={alarm.alarm_id} alarm={alarm} />
      ))}
    </Dialog>
  );
}

function Reason({ alarm }: { alarm: AlarmView }) {
  const explanation = useSignal<AlarmExplanationAnswer | null>(null);
  useEffect(() => {
    let isWanted = true;
    void attempt(api.alarmExplanation(alarm.alarm_id)).then((answer) => {
      if (isWanted) explanation.value = answer;
    });
    return () => {
      isWanted = false;
    };
  }, [alarm.alarm_id]);
  const found = explanation.value;
  return (
    <section aria-label={alarmLabel(alarm)}>
      <h3>{alarmText(alarm)}</h3>
      {found && <Thresholds explanation={found} />}
      {found && <HearAlarm raisedMs={found.raised_ms} />}
      {found && (
        <UnitTimeline
          unitId={alarm.unit_id}
          only={{ fromMs: found.raised_ms - ABOUT_MS, untilMs: found.raised_ms + ABOUT_MS }}
        />
      )}
    </section>
  );
}

function Thresholds({ explanation }: { explanation: AlarmExplanationAnswer }) {
  const thresholds = thresholdsText(explanation);
  return (
    <>
      <p>{crossingText(explanation) ?? t("alarm.no_threshold")}</p>
      {thresholds !== "" && <p class="quiet">{t("alarm.thresholds", { thresholds })}</p>}
    </>
  );
}
