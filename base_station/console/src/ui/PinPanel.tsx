import { useSignal } from "@preact/signals";
import { attempt } from "../sessions";
import * as api from "../api";
import type { Picture } from "../live/picture";
import { codedText } from "../live/codedText";
import { displayName, nameAmong } from "../live/urgency";
import { putDown } from "../plan/tools";
import type { PinView, UnitView } from "../wire";
import { clockTime, minutes } from "../format";
import { length, listed } from "../language/measures";
import { knownLabel, type PlainKey, t } from "../language/translate";
import { ConfirmButton } from "./ConfirmButton";
import { PanelActions } from "./PanelActions";
import { useSinglePress } from "./useGuardedPress";
import { FloorField, placeOf, PlaceFields, WithinField } from "./PlaceFields";
import { fields } from "./useLoaded";

interface Props {
  picture: Picture;
  unitId: string;
  pin: PinView | null; // null: a new one
}

/** "This person was here then": it corrects the whole trail, not only the place now. */
export function PinPanel({ picture, unitId, pin }: Props) {
  const name = nameOf(picture, unitId);
  const once = useSinglePress();
  const fixed = pin !== null && pin.kind !== "place"; // it can only be removed
  const at =
    pin === null || pin.north_m === null || pin.east_m === null
      ? undefined
      : { north_m: pin.north_m, east_m: pin.east_m };
  const send = (event: SubmitEvent) => {
    const given = fields(event);
    const t_ms = timeOf(given, picture);
    const said = { unit_id: unitId, ...placeOf(given, at), note: given["note"] ?? "" };
    const sent = () =>
      pin === null
        ? api.setPin({ ...said, t_ms })
        : api.movePin(pin.pin_id, given["when"] === AS_SET ? said : { ...said, t_ms });
    once(() => attempt(sent()).then((done) => done && putDown()));
  };
  return (
    <form class="tool-panel" aria-label={t("pin.title", { name })} onSubmit={send}>
      <h3>
        {pin?.kind === "meeting"
          ? t("pin.met", { name, other: nameOf(picture, pin.other_id) })
          : t("pin.was_here", { name })}
      </h3>
      {pin !== null && <Verdict pin={pin} />}
      {!fixed && (
        <>
          <PlaceFields {...(at === undefined ? {} : { start: at })} />
          <WithinField startM={2 * (pin?.std_m ?? 1)} />
          <WhenField set={pin === null ? null : pin.t_ms} />
          <FloorField picture={picture} start={pin?.floor} />
          <label>
            {t("pin.note")}
            <input name="note" maxLength={200} defaultValue={pin?.note ?? ""} />
          </label>
        </>
      )}
      <PanelActions label={fixed ? null : t(pin === null ? "pin.set" : "pin.move")}>
        {pin !== null && (
          <ConfirmButton
            label={t("pin.remove")}
            question={t("pin.remove_question")}
            onConfirm={() => void attempt(api.removePin(pin.pin_id)).then(putDown)}
          />
        )}
      </PanelActions>
    </form>
  );
}

/** The state of a pin. */
function Verdict({ pin }: { pin: PinView }) {
  const state = knownLabel("pin", `state_${pin.state}`) ?? pin.state;
  return (
    <p class={`verdict ${pin.state}`}>
      <strong>
        {pin.residual_m === null
          ? t("pin.verdict", { state })
          : t("pin.off", { state, distance: length(pin.residual_m) })}
      </strong>{" "}
      {pin.text === "" ? "" : `${codedText(pin.text_code ?? undefined, pin.text)}. `}
      <span class="quiet">{t("pin.set_by", { who: pin.by, time: clockTime(pin.set_ms) })}</span>
    </p>
  );
}

/**
 * Where everybody who is on duty was together, for instance at the engine: where their paths begin,
 * or at a time, as those need whose units were switched on long before.
 */
export function StartPanel({ picture }: { picture: Picture }) {
  const units = onDuty(picture);
  const once = useSinglePress();
  const send = (event: SubmitEvent) => {
    const given = fields(event);
    const facing = given["facing"] ?? "";
    const start = {
      unit_ids: units.map((unit) => unit.unit_id),
      ...placeOf(given),
      t_ms: given["when"] === AS_SET ? 0 : (timeOf(given, picture) ?? Math.round(picture.nowMs.peek())),
      heading_rad: facing === "" ? null : (Number(facing) * Math.PI) / 180,
      note: "",
    };
    once(() => attempt(api.startTogether(start)).then((done) => done && putDown()));
  };
  return (
    <form class="tool-panel" aria-label={t("pin.start")} onSubmit={send}>
      <h3>{t("pin.start_of_all")}</h3>
      <Everybody names={units.map(displayName)} />
      <PlaceFields />
      <WithinField startM={4} />
      <WhenField set={0} />
      <label>
        {t("pin.facing")}
        <select name="facing">
          <option value="">{t("pin.unknown")}</option>
          {COMPASS.map(([word, degrees]) => (
            <option key={word} value={degrees}>
              {t("pin.of_plan", { direction: t(word) })}
            </option>
          ))}
        </select>
      </label>
      <FloorField picture={picture} start={undefined} />
      <PanelActions label={t("pin.set_start")} />
    </form>
  );
}

const MANY = 6;

/** Forty names would push the notice off the screen. */
function Everybody({ names }: { names: readonly string[] }) {
  const all = listed(names) || t("pin.nobody");
  if (names.length <= MANY) return <p>{all}</p>;
  return (
    <details class="everybody">
      <summary>{t("pin.all_on_duty", { count: names.length })}</summary>
      {all}
    </details>
  );
}

const COMPASS: readonly [PlainKey, number][] = [
  ["direction.n", 0],
  ["direction.ne", 45],
  ["direction.e", 90],
  ["direction.se", 135],
  ["direction.s", 180],
  ["direction.sw", 225],
  ["direction.w", 270],
  ["direction.nw", 315],
];

/** Two people were at the same place, which may be unknown. */
export function MeetingPanel({ picture, unitId }: { picture: Picture; unitId: string }) {
  const first = onDuty(picture).find((unit) => unit.unit_id !== unitId);
  const whom = useSignal(first?.unit_id ?? "");
  // Whoever was chosen stays there, else the list would turn to its first entry.
  const others = registered(picture).filter(
    (unit) => unit.unit_id !== unitId && (unit.person !== null || unit.unit_id === whom.value),
  );
  const once = useSinglePress();
  const send = (event: SubmitEvent) => {
    const given = fields(event);
    const meeting = {
      unit_id: unitId,
      other_unit_id: given["other"] ?? "",
      std_m: Number(given["within"]) / 2,
      t_ms: timeOf(given, picture),
      note: "",
    };
    once(() => attempt(api.setMeeting(meeting)).then((done) => done && putDown()));
  };
  return (
    <form class="tool-panel" aria-label={t("pin.meeting")} onSubmit={send}>
      <h3>{t("pin.meeting_of", { name: nameOf(picture, unitId) })}</h3>
      <label>
        {t("pin.with")}
        <select
          name="other"
          required
          value={whom.value}
          onChange={(event) => (whom.value = event.currentTarget.value)}
        >
          {others.map((unit) => (
            <option key={unit.unit_id} value={unit.unit_id}>
              {nameAmong(unit, others)}
            </option>
          ))}
        </select>
      </label>
      <WhenField set={null} />
      <WithinField startM={2} />
      <PanelActions label={t("pin.save")} />
    </form>
  );
}

const MINUTES_AGO = [0, 1, 2, 3, 5, 10, 15, 20, 30];
const AS_SET = ""; // the time that stands there already

/** Time of the pin; `set` is the time of a pin that is edited. */
function WhenField({ set }: { set: number | null }) {
  return (
    <label>
      {t("pin.when")}
      <select name="when">
        {set !== null && (
          <option value={AS_SET}>{set === 0 ? t("pin.at_start") : clockTime(set)}</option>
        )}
        {MINUTES_AGO.map((ago) => (
          <option key={ago} value={ago}>
            {ago === 0 ? t("pin.now") : t("pin.ago", { time: minutes(ago * 60_000) })}
          </option>
        ))}
      </select>
    </label>
  );
}

/** Null for now: the station sets the time. */
function timeOf(given: Record<string, string>, picture: Picture): number | null {
  const ago = Number(given["when"] ?? "0");
  return ago === 0 ? null : Math.round(picture.nowMs.peek() - ago * 60_000);
}

function onDuty(picture: Picture): UnitView[] {
  return registered(picture).filter((unit) => unit.person !== null);
}

function registered(picture: Picture): UnitView[] {
  void picture.unitsChanged.value;
  return picture.allUnits().filter((unit) => unit.registered);
}

function nameOf(picture: Picture, unitId: string): string {
  const unit = picture.unit(unitId)?.value;
  return unit === undefined ? unitId : displayName(unit);
}
