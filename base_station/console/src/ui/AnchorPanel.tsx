import { useSignal } from "@preact/signals";
import { attempt } from "../sessions";
import * as api from "../api";
import type { Picture } from "../live/picture";
import { anchorThrough, doubtOf, type Fit, type Known } from "../plan/anchor";
import { clicked, putDown, type Place } from "../plan/tools";
import { Ends } from "./PinPanel";
import { fields } from "./useLoaded";

/** Where the plan lies on the Earth: two points of it, clicked, with latitude and longitude. */
export function AnchorPanel({ picture }: { picture: Picture }) {
  const fit = useSignal<Fit | null>(null);
  const [one, other] = clicked.value;
  const take = (given: Record<string, string>) => {
    if (one === undefined || other === undefined) return;
    const height = picture.anchor.value?.height_m ?? 0;
    fit.value = anchorThrough(known(given, "one", one), known(given, "other", other), height);
  };
  const doubt = fit.value === null ? "" : doubtOf(fit.value);
  const send = (event: SubmitEvent) => {
    take(fields(event));
    const found = fit.value;
    if (found === null || doubtOf(found) !== "") return;
    void attempt(api.setAnchor(found.anchor).then(() => true)).then((done) => done && putDown());
  };
  return (
    <form class="tool-panel" aria-label="Place on the Earth" onSubmit={send}>
      <h3>Place on the Earth</h3>
      <Point name="one" label="First point" place={one} />
      <Point name="other" label="Second point" place={other} />
      {doubt !== "" && (
        <p class="verdict conflict" role="alert">
          {doubt}
        </p>
      )}
      <p class="quiet">Take two corners far apart. A map or a GPS receiver tells where they are.</p>
      <Ends label={one !== undefined && other !== undefined ? "Set place" : null} />
    </form>
  );
}

interface PointProps {
  name: string;
  label: string;
  place: Place | undefined;
}

function Point({ name, label, place }: PointProps) {
  return (
    <fieldset class="place">
      <legend>
        {label}:{" "}
        {place === undefined
          ? "click on the plan"
          : `${place.north_m.toFixed(1)} m north, ${place.east_m.toFixed(1)} m east`}
      </legend>
      <label>
        Latitude, °
        <input name={`${name}-lat`} type="number" step="any" min={-90} max={90} required />
      </label>
      <label>
        Longitude, °
        <input name={`${name}-lon`} type="number" step="any" min={-180} max={180} required />
      </label>
    </fieldset>
  );
}

function known(given: Record<string, string>, name: string, place: Place): Known {
  return {
    place,
    lat_deg: Number(given[`${name}-lat`]),
    lon_deg: Number(given[`${name}-lon`]),
  };
}
