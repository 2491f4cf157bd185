import { picture as shown } from "../sessions";
import { inAlarm } from "../live/alarms";
import type { UnitView } from "../wire";
import { t } from "../language/translate";
import { ConfirmButton } from "./ConfirmButton";

interface Props {
  label: string;
  about?: string; // read aloud, where the label alone could be anybody's
  members: readonly UnitView[]; // members whose answers it enters
  question: string;
  always?: boolean; // it asks also without an alarm
  kind?: string; // of button
  onConfirm: (press: MouseEvent) => void;
}

/** Enters an answer by radio.  For a member in alarm it asks first, and names the alarms. */
export function ByRadio({ label, about, members, question, always = false, kind, onConfirm }: Props) {
  const needy = inAlarm(members, shown.value?.alarms.value ?? new Map());
  if (needy.length > 0 || always) {
    const asked =
      needy.length === 0 ? question : t("radio.in_alarm", { members: needy.join("; "), question });
    return (
      <ConfirmButton
        label={label}
        {...(about === undefined ? {} : { about })}
        question={asked}
        yes={t("radio.yes")}
        onConfirm={onConfirm}
      />
    );
  }
  const spoken = about === undefined ? {} : { "aria-label": t("common.about", { action: label, what: about }) };
  return (
    <button type="button" class={kind} {...spoken} onClick={onConfirm}>
      {label}
    </button>
  );
}
