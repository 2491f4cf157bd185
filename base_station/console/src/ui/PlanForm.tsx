import { useSignal } from "@preact/signals";
import { ApiError } from "../http";
import { contents } from "../plan/contents";
import { attempt } from "../sessions";
import type { Plan } from "../wire";
import { t } from "../language/translate";
import { onDemand } from "./onDemand";
import { SendPlan } from "./SendPlan";

const DraftPlan = onDemand(() => import("./DraftPlan").then((part) => part.DraftPlan));
const PlanDrawing = onDemand(() => import("./PlanDrawing").then((part) => part.PlanDrawing));

/** The plan that is shown, and another in its place: a file is only looked at until it is sent. */
export function PlanForm({ shown }: { shown: Plan | null }) {
  const chosen = useSignal<Partial<Plan> | null>(null);
  const drawing = useSignal<File | null>(null); // from elsewhere
  const byHand = useSignal(false);
  const choose = async (file: File | undefined) => {
    chosen.value = drawing.value = null;
    byHand.value = false;
    if (!file) return;
    const plan = isJson(file) ? parsed(await file.text()) : null;
    if (plan?.muster === undefined) drawing.value = file;
    else chosen.value = plan;
  };
  return (
    <>
      <p>
        {shown === null
          ? t("plan_form.none")
          : t("plan_form.shown", { plan: contents(shown) })}
      </p>
      <label class="row">
        {t("plan_form.new")}
        <input
          type="file"
          accept=".geojson,.json,application/geo+json,.zip,.imdf,.dxf,.ifc,.ifczip,.pdf,.png,.jpg,.jpeg,.webp"
          onChange={(event) => void attempt(choose(event.currentTarget.files?.[0]))}
        />
      </label>
      <p>
        <button
          type="button"
          aria-pressed={byHand.value}
          onClick={() => {
            chosen.value = drawing.value = null;
            byHand.value = !byHand.value;
          }}
        >
          {t("plan_form.draw")}
        </button>
      </p>
      {chosen.value !== null && (
        <div class="row">
          <span>{t("plan_form.file", { plan: contents(chosen.value) })}</span>
          <SendPlan plan={chosen.value} replaces={shown !== null} />
        </div>
      )}
      {drawing.value !== null && (
        <DraftPlan file={drawing.value} shown={shown} done={() => (drawing.value = null)} />
      )}
      {byHand.value && <PlanDrawing picture={null} shown={shown} name={t("plan_form.by_hand")} />}
    </>
  );
}

function isJson(file: File): boolean {
  return /\.(geo)?json$/i.test(file.name);
}

function parsed(text: string): Partial<Plan> {
  try {
    const said: unknown = JSON.parse(text);
    if (typeof said === "object" && said !== null) return said;
  } catch {
    // Reported below, as for any other invalid file.
  }
  throw new ApiError(t("plan_form.not_geojson"), 0);
}
