import { useSignal, useSignalEffect } from "@preact/signals";
import { attempt, namedIncident } from "../sessions";
import * as api from "../api";
import type { LatLon } from "../api";
import type { Picture } from "../live/picture";
import { anchorThrough, changeOf, doubtOf, type Fit, type Known } from "../plan/anchor";
import { baseMap } from "../plan/baseMap";
import { clicked, putDown, type Place } from "../plan/tools";
import type { AnchorView } from "../wire";
import { place as inWords } from "../format";
import { t } from "../language/translate";
import { CoordinateFields, coordinatesOf } from "./CoordinateFields";
import { PanelActions } from "./PanelActions";
import { MapPicker } from "./MapPicker";
import { ReplacePlace } from "./ReplacePlace";
import { fields } from "./useLoaded";

/** Georeference of the plan: two clicked points with latitude and longitude. */
export function AnchorPanel({ picture }: { picture: Picture }) {
  const fit = useSignal<Fit | null>(null);
  const picked = useSignal<readonly LatLon[]>([]);
  const map = baseMap.value;
  const [one, other] = clicked.value;
  const take = (given: Record<string, string>) => {
    if (one === undefined || other === undefined) return;
    const height = picture.anchor.value?.height_m ?? 0;
    fit.value = anchorThrough(known(given, "one", one), known(given, "other", other), height);
  };
  const doubt = fit.value === null ? "" : doubtOf(fit.value);
  const asked = useSignal<AnchorView | null>(null);
  const shown = picture.anchor.value;
  const isNone = () => (asked.value = null);
  useSignalEffect(() => {
    void [clicked.value, picked.value];
    isNone(); // it was asked of other points
  });
  const send = (next: AnchorView) =>
    void attempt(api.setAnchor(next, namedIncident()).then(() => true)).then((done) => done && putDown());
  const submit = (event: SubmitEvent) => {
    take(fields(event));
    const found = fit.value;
    if (found === null || doubtOf(found) !== "") return;
    if (shown === null || changeOf(shown, found.anchor) === "") send(found.anchor);
    else asked.value = found.anchor;
  };
  const question = asked.value !== null && shown !== null && (
    <ReplacePlace shown={shown} next={asked} onYes={send} />
  );
  return (
    <form class="tool-panel" aria-label={t("anchor.title")} onInput={isNone} onSubmit={submit}>
      <h3>{t("anchor.title")}</h3>
      <Point name="one" label={t("anchor.first_point")} place={one} at={picked.value[0]} />
      <Point name="other" label={t("anchor.second_point")} place={other} at={picked.value[1]} />
      {map !== null && (
        <MapPicker
          map={map}
          marks={picked.value}
          pick={(at) => (picked.value = picked.value.length < 2 ? [...picked.value, at] : [at])}
        />
      )}
      {doubt !== "" && (
        <p class="verdict conflict" role="alert">
          {doubt}
        </p>
      )}
      <p class="quiet">{t(map === null ? "anchor.hint" : "anchor.hint_map")}</p>
      <PanelActions
        label={one !== undefined && other !== undefined ? t("anchor.save") : null}
        question={question || null}
      />
    </form>
  );
}

interface PointProps {
  name: string;
  label: string;
  place: Place | undefined;
  at: LatLon | undefined; // as clicked on the map
}

function Point({ name, label, place, at }: PointProps) {
  return (
    <fieldset class="place">
      <legend>
        {t("anchor.point", { point: label, where: place === undefined ? t("anchor.click") : inWords(place) })}
      </legend>
      <CoordinateFields label={t("anchor.latitude")} prefix={`${name}-`} at={at} />
    </fieldset>
  );
}

function known(given: Record<string, string>, name: string, place: Place): Known {
  return { place, ...coordinatesOf(given, `${name}-`) };
}
