import { attempt, namedIncident } from "../sessions";
import * as api from "../api";
import type { Picture } from "../live/picture";
import { putDown } from "../plan/tools";
import type { BeaconView } from "../wire";
import { age } from "../format";
import { lengthField, lengthUnit, metresOf, shownLength } from "../language/measures";
import { t } from "../language/translate";
import { ConfirmButton } from "./ConfirmButton";
import { PanelActions } from "./PanelActions";
import { FloorField, placeOf, PlaceFields, WithinField } from "./PlaceFields";
import { fields } from "./useLoaded";

interface Props {
  picture: Picture;
  beacon: BeaconView | null; // null: a new one
}

/** A beacon or tag is mounted here: members who pass it are known to have been near. */
export function BeaconPanel({ picture, beacon }: Props) {
  const send = (event: SubmitEvent) => {
    const given = fields(event);
    const wanted = {
      beacon_id: beacon?.beacon_id ?? given["beacon"] ?? "",
      label: given["label"] ?? "",
      reach_m: metresOf(Number(given["reach"])),
      ...placeOf(given, beacon ?? undefined),
    };
    void attempt(api.placeBeacon(wanted, namedIncident())).then((done) => done && putDown());
  };
  const seenMs = beacon?.seen_ms ?? null;
  return (
    <form class="tool-panel" aria-label={t("beacon.title")} onSubmit={send}>
      <h3>{beacon === null ? t("beacon.new") : beacon.label || beacon.beacon_id}</h3>
      {beacon === null ? (
        <label>
          {t("beacon.number")}
          <input name="beacon" required maxLength={64} />
        </label>
      ) : (
        <p class="quiet">
          {seenMs === null
            ? t("beacon.not_passed")
            : t("beacon.passed", { age: age(picture.nowMs.value - seenMs) })}
        </p>
      )}
      <label>
        {t("common.name")}
        <input name="label" maxLength={80} defaultValue={beacon?.label ?? ""} />
      </label>
      <PlaceFields {...(beacon === null ? {} : { start: beacon })} />
      <WithinField startM={2 * (beacon?.std_m ?? 0.5)} />
      <label>
        {t("beacon.reach", { unit: lengthUnit() })}
        <input
          name="reach"
          type="number"
          min={0}
          max={shownLength(100)}
          step="any"
          required
          defaultValue={lengthField(beacon?.reach_m ?? 3)}
        />
      </label>
      <FloorField picture={picture} start={beacon?.floor} />
      <PanelActions label={t(beacon === null ? "beacon.place" : "beacon.save")}>
        {beacon !== null && (
          <ConfirmButton
            label={t("beacon.remove")}
            question={t("beacon.remove_question")}
            onConfirm={() => void attempt(api.removeBeacon(beacon.beacon_id)).then(putDown)}
          />
        )}
      </PanelActions>
    </form>
  );
}
