import { useSignal } from "@preact/signals";
import { setPlan } from "../api";
import { ApiError } from "../http";
import { contents } from "../plan/contents";
import { attempt } from "../sessions";
import { dialog } from "../uiState";
import type { Plan } from "../wire";
import { ConfirmButton } from "./ConfirmButton";

/** The plan that is shown, and another in its place: a file is only looked at until it is sent. */
export function PlanForm({ shown }: { shown: Plan | null }) {
  const chosen = useSignal<Partial<Plan> | null>(null);
  const choose = async (file: File | undefined) => {
    chosen.value = null;
    if (file) chosen.value = parsed(await file.text());
  };
  return (
    <>
      <p>
        {shown === null
          ? "There is no plan; people are shown on a metre grid."
          : `Shown is ${contents(shown)}.`}
      </p>
      <label class="row">
        New plan (GeoJSON in site metres)
        <input
          type="file"
          accept=".geojson,.json,application/geo+json"
          onChange={(event) => void attempt(choose(event.currentTarget.files?.[0]))}
        />
      </label>
      {chosen.value !== null && <Send chosen={chosen.value} replaces={shown !== null} />}
    </>
  );
}

function Send({ chosen, replaces }: { chosen: Partial<Plan>; replaces: boolean }) {
  const send = () => void attempt(setPlan(chosen).then(() => (dialog.value = null)));
  return (
    <div class="row">
      <span>The file has {contents(chosen)}.</span>
      {replaces ? (
        <ConfirmButton
          label="Replace plan"
          question="Replace the plan for everybody?"
          onConfirm={send}
        />
      ) : (
        <button type="button" class="primary" onClick={send}>
          Set plan
        </button>
      )}
    </div>
  );
}

function parsed(text: string): Partial<Plan> {
  try {
    const said: unknown = JSON.parse(text);
    if (typeof said === "object" && said !== null) return said;
  } catch {
    // Said below, as of any other file that is none.
  }
  throw new ApiError("This file is no GeoJSON.", 0);
}
