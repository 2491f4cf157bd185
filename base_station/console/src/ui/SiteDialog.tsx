import { useSignal } from "@preact/signals";
import { setAnchor } from "../api";
import { attempt, live, namedIncident } from "../sessions";
import { dialog } from "../uiState";
import { changeOf, placeWords } from "../plan/anchor";
import { take } from "../plan/tools";
import type { AnchorView } from "../wire";
import { t } from "../language/translate";
import { BaseMapForm } from "./BaseMapForm";
import { CoordinateFields, coordinatesOf } from "./CoordinateFields";
import { useFocusBack } from "./Confirm";
import { Dialog } from "./Dialog";
import { PlanForm } from "./PlanForm";
import { ReplacePlace } from "./ReplacePlace";
import { fields } from "./useLoaded";

const DEGREES = 180 / Math.PI;

export function SiteDialog() {
  const picture = live.value?.picture;
  return (
    <Dialog title={t("site.title")} wide>
      <h3>{t("site.plan")}</h3>
      <PlanForm shown={picture?.plan.value ?? null} />
      <h3>{t("site.base_map")}</h3>
      <BaseMapForm />
      <h3>{t("site.place")}</h3>
      <p>
        <button
          type="button"
          onClick={() => {
            dialog.value = null;
            take({ kind: "anchor" });
          }}
        >
          {t("site.align")}
        </button>{" "}
        {t("site.by_fix")}
      </p>
      <AnchorForm anchor={picture?.anchor.value ?? null} />
    </Dialog>
  );
}

/** As with the plan, one that is there is not replaced without asking. */
function AnchorForm({ anchor }: { anchor: AnchorView | null }) {
  const asked = useSignal<AnchorView | null>(null);
  const button = useFocusBack(asked.value !== null);
  const send = (next: AnchorView) =>
    void attempt(setAnchor(next, namedIncident()).then(() => (dialog.value = null)));
  return (
    <form
      class="row"
      onInput={() => (asked.value = null)}
      onSubmit={(event) => {
        const next = anchorOf(fields(event));
        if (anchor === null || changeOf(anchor, next) === "") send(next);
        else asked.value = next;
      }}
    >
      <p class="whole">
        {anchor === null
          ? t("site.nowhere")
          : t("site.at", { place: placeWords(anchor) })}
      </p>
      <CoordinateFields label={t("site.latitude")} at={anchor === null ? undefined : [anchor.lat_deg, anchor.lon_deg]} />
      <NumberField name="height" label={t("site.height")} value={anchor?.height_m ?? 0} />
      <NumberField
        name="turn"
        label={t("site.heading")}
        value={(anchor?.plan_rotation_rad ?? 0) * DEGREES}
      />
      {asked.value === null || anchor === null ? (
        <button class="primary" ref={button}>
          {t("site.save")}
        </button>
      ) : (
        <ReplacePlace shown={anchor} next={asked} onYes={send} />
      )}
    </form>
  );
}

function anchorOf(given: Record<string, string>): AnchorView {
  const number = (name: string) => Number(given[name]);
  return {
    ...coordinatesOf(given),
    height_m: number("height"),
    plan_rotation_rad: number("turn") / DEGREES,
  };
}

interface NumberFieldProps {
  name: string;
  label: string;
  value: number | undefined;
}

function NumberField({ name, label, value }: NumberFieldProps) {
  return (
    <label>
      {label}
      <input name={name} type="number" step="any" required defaultValue={value} />
    </label>
  );
}
