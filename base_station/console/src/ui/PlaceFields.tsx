import { clicked, type Place } from "../plan/tools";
import { floor } from "../uiState";
import type { Picture } from "../live/picture";
import { floorsOf } from "../plan/floors";
import { floorName } from "../format";
import { length } from "../language/measures";
import { t } from "../language/translate";

/** Position on the plan: clicked, or typed by keyboard users. */
export function PlaceFields({ start }: { start?: Place }) {
  const at = clicked.value.at(-1) ?? start;
  return (
    <fieldset class="place">
      <legend>
        {t(at === undefined ? "pin.place_click" : "pin.place")}
      </legend>
      <Metres name="north" label={t("pin.north", { unit: "m" })} value={at?.north_m} />
      <Metres name="east" label={t("pin.east", { unit: "m" })} value={at?.east_m} />
    </fieldset>
  );
}

function Metres({ name, label, value }: { name: string; label: string; value?: number }) {
  const shown = value === undefined ? "" : inTenths(value);
  return (
    <label>
      {label}
      <input key={shown} name={name} type="number" step="0.1" required defaultValue={shown} />
    </label>
  );
}

function inTenths(metres: number): string {
  return metres.toFixed(1);
}

interface FloorFieldProps {
  picture: Picture;
  start: number | null | undefined; // undefined: nobody has said yet
}

/** Floor of the position; initially the shown one. */
export function FloorField({ picture, start }: FloorFieldProps) {
  const floorsShown = floorsOf(picture.plan.value, picture.allUnits(), new Map(), floor.value);
  const known = floorsShown.map((one) => one.floor);
  const isAnother = typeof start === "number" && !known.includes(start);
  const floors = isAnother ? [...known, start].sort((a, b) => b - a) : known;
  if (floors.length === 0) return null;
  const shown = floor.value === "all" ? null : floor.value;
  const first = start === undefined ? shown : start;
  return (
    <label>
      {t("pin.floor")}
      <select name="floor" defaultValue={String(first ?? "")}>
        <option value="">{t("pin.unknown")}</option>
        {floors.map((one) => (
          <option key={one} value={String(one)}>
            {floorName(one)}
          </option>
        ))}
      </select>
    </label>
  );
}

const WITHIN_M = [0.5, 1, 2, 4, 10, 20];

/** Uncertainty of the position; the API has the standard deviation, the form the 95 % radius ("within"). */
export function WithinField({ startM }: { startM: number }) {
  const choices = [...new Set([...WITHIN_M, startM])].sort((a, b) => a - b);
  return (
    <label>
      {t("pin.accuracy")}
      <select name="within" defaultValue={String(startM)}>
        {choices.map((metres) => (
          <option key={metres} value={metres}>
            {length(metres, metres < 1 ? 1 : 0)}
          </option>
        ))}
      </select>
    </label>
  );
}

/** The fields of a submitted form as numbers and positions; an unchanged position is exactly the initial
 * one. */
export function placeOf(given: Record<string, string>, start?: Place) {
  const metres = (text: string | undefined, before: number | undefined) =>
    before !== undefined && text === inTenths(before) ? before : Number(text);
  return {
    north_m: metres(given["north"], start?.north_m),
    east_m: metres(given["east"], start?.east_m),
    std_m: Number(given["within"]) / 2,
    floor: (given["floor"] ?? "") === "" ? null : Number(given["floor"]),
  };
}
