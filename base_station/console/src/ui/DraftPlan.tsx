import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import * as api from "../api";
import { codedTexts } from "../live/codedText";
import { placeWords } from "../plan/anchor";
import { contents } from "../plan/contents";
import { attempt } from "../sessions";
import type { AnchorView, Plan } from "../wire";
import { t } from "../language/translate";
import { PlanDrawing } from "./PlanDrawing";
import { SendPlan } from "./SendPlan";
import { Waiting } from "./Waiting";

const UNITS = ["mm", "cm", "m", "in", "ft"];
/** Refused: with another unit it may be read. */
const NOTHING: api.PlanDraft = {
  picture: null,
  plan: null,
  lat_deg: null,
  lon_deg: null,
  plan_rotation_rad: 0,
  is_place_surveyed: false,
  pages: 1,
  notes: [],
  note_codes: [],
};

interface Props {
  file: File;
  shown: Plan | null;
  done: () => void;
}

/** A file from elsewhere: a picture that is scaled here, or a plan as the station has read it. */
export function DraftPlan({ file, shown, done }: Props) {
  const draft = useSignal<api.PlanDraft | null>(null);
  const page = useSignal(1);
  const unit = useSignal("");
  const usesPlace = useSignal(true);
  const name = file.name.replace(/\.[^.]*$/, "").slice(0, 80);
  const isDxf = /\.dxf$/i.test(file.name);
  useEffect(() => {
    let isWanted = true;
    draft.value = null;
    void attempt(api.draftPlan(file, name, page.value, unit.value)).then((read) => {
      if (!isWanted) return;
      usesPlace.value = read?.is_place_surveyed ?? false;
      if (read === null && !isDxf) done();
      else draft.value = read ?? NOTHING;
    });
    return () => {
      isWanted = false;
    };
  }, [file, page.value, unit.value]);
  const read = draft.value;
  if (read === null) return <Waiting />;
  const place = placeOf(read);
  return (
    <>
      {isDxf && (
        <label class="row">
          {t("draft.unit")}
          <select value={unit.value} onChange={(event) => (unit.value = event.currentTarget.value)}>
            <option value="">{t("draft.unit_of_file")}</option>
            {UNITS.map((one) => (
              <option key={one}>{one}</option>
            ))}
          </select>
        </label>
      )}
      {read.pages > 1 && (
        <label class="row">
          {t("draft.page")}
          <select value={page.value} onChange={(event) => (page.value = Number(event.currentTarget.value))}>
            {Array.from({ length: read.pages }, (_, at) => (
              <option key={at} value={at + 1}>
                {t("draft.page_of", { page: at + 1, all: read.pages })}
              </option>
            ))}
          </select>
        </label>
      )}
      {codedTexts(read.notes, read.note_codes).map((note) => (
        <p key={note} class="warned">
          {note}
        </p>
      ))}
      {read.picture !== null && (
        <PlanDrawing key={`page ${page.value}`} picture={read.picture} shown={shown} name={name} />
      )}
      {place !== null && (
        <label class="choice">
          <input
            type="checkbox"
            checked={usesPlace.value}
            onChange={(event) => (usesPlace.value = event.currentTarget.checked)}
          />
          <span>{t("draft.use_place", { place: placeWords(place) })}</span>
        </label>
      )}
      {read.plan !== null && (
        <div class="row">
          <span>{t("draft.contents", { contents: contents(read.plan as Partial<Plan>) })}</span>
          <SendPlan plan={read.plan} replaces={shown !== null} place={usesPlace.value ? place : null} />
        </div>
      )}
    </>
  );
}

/** Of the plan's origin on the Earth, where the file has it. */
function placeOf({ lat_deg, lon_deg, plan_rotation_rad }: api.PlanDraft): AnchorView | null {
  if (lat_deg === null || lon_deg === null) return null;
  return { lat_deg, lon_deg, height_m: 0, plan_rotation_rad };
}
