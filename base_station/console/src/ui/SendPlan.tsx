import { setAnchor, setPlan } from "../api";
import { attempt, namedIncident } from "../sessions";
import { dialog } from "../uiState";
import type { AnchorView } from "../wire";
import { t } from "../language/translate";
import { ConfirmButton } from "./ConfirmButton";

interface Props {
  plan: object;
  replaces: boolean;
  /** Of its origin on the Earth. */
  place?: AnchorView | null;
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
  if (place) await setAnchor(place, incidentId);
}
