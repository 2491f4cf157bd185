import { setAnchor, setPlan } from "../api";
import { attempt, namedIncident } from "../sessions";
import { dialog } from "../uiState";
import { t } from "../language/translate";
import { ConfirmButton } from "./ConfirmButton";

interface Props {
  plan: object;
  replaces: boolean;
  /** Of its origin on the Earth, where the file says it. */
  place?: { lat_deg: number | null; lon_deg: number | null };
}

/** One that is there is not replaced without asking. */
export function SendPlan({ plan, replaces, place }: Props) {
  const send = () => void attempt(sent(plan, place).then(() => (dialog.value = null)));
  return replaces ? (
    <ConfirmButton label={t("site.replace_plan")} question={t("site.replace_plan_question")} onConfirm={send} />
  ) : (
    <button type="button" class="primary" onClick={send}>
      {t("site.set_plan")}
    </button>
  );
}

async function sent(plan: object, place: Props["place"]): Promise<void> {
  const incidentId = namedIncident();
  await setPlan(plan, incidentId);
  if (!place || place.lat_deg === null || place.lon_deg === null) return;
  const anchor = { lat_deg: place.lat_deg, lon_deg: place.lon_deg, height_m: 0, plan_rotation_rad: 0 };
  await setAnchor(anchor, incidentId);
}
