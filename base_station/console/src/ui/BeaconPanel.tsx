import { attempt, namedIncident } from "../sessions";
import * as api from "../api";
import type { Picture } from "../live/picture";
import { putDown } from "../plan/tools";
import type { BeaconView } from "../wire";
import { age } from "../format";
import { ConfirmButton } from "./ConfirmButton";
import { PanelActions } from "./PanelActions";
import { FloorField, placeOf, PlaceFields, WithinField } from "./PlaceFields";
import { fields } from "./useLoaded";

interface Props {
  picture: Picture;
  beacon: BeaconView | null; // null: a new one
}

/** A beacon or tag hangs here: whoever passes it is known to have been near. */
export function BeaconPanel({ picture, beacon }: Props) {
  const send = (event: SubmitEvent) => {
    const given = fields(event);
    const wanted = {
      beacon_id: beacon?.beacon_id ?? given["beacon"] ?? "",
      label: given["label"] ?? "",
      reach_m: Number(given["reach"]),
      ...placeOf(given, beacon ?? undefined),
    };
    void attempt(api.placeBeacon(wanted, namedIncident())).then((done) => done && putDown());
  };
  const seenMs = beacon?.seen_ms ?? null;
  return (
    <form class="tool-panel" aria-label="Beacon" onSubmit={send}>
      <h3>{beacon === null ? "A beacon hangs here" : beacon.label || beacon.beacon_id}</h3>
      {beacon === null ? (
        <label>
          Its number
          <input name="beacon" required maxLength={64} />
        </label>
      ) : (
        <p class="quiet">
          {seenMs === null
            ? "No unit has passed it yet."
            : `A unit passed it ${age(picture.nowMs.value - seenMs)} ago.`}
        </p>
      )}
      <label>
        Name
        <input name="label" maxLength={80} defaultValue={beacon?.label ?? ""} />
      </label>
      <PlaceFields {...(beacon === null ? {} : { start: beacon })} />
      <WithinField startM={2 * (beacon?.std_m ?? 0.5)} />
      <label>
        Noticed from, m
        <input
          name="reach"
          type="number"
          min={0}
          max={100}
          step="0.5"
          required
          defaultValue={beacon?.reach_m ?? 3}
        />
      </label>
      <FloorField picture={picture} start={beacon?.floor} />
      <PanelActions label={beacon === null ? "Place beacon" : "Change beacon"}>
        {beacon !== null && (
          <ConfirmButton
            label="Remove beacon"
            question="Nobody who passes it is placed by it any more."
            onConfirm={() => void attempt(api.removeBeacon(beacon.beacon_id)).then(putDown)}
          />
        )}
      </PanelActions>
    </form>
  );
}
