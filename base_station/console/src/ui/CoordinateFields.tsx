import { useSignal } from "@preact/signals";
import { useRef } from "preact/hooks";
import type { LatLon } from "../api";
import { t } from "../language/translate";
import { coordinatesIn, degreesIn } from "../plan/coordinates";

interface Props {
  label: string; // of the latitude
  prefix?: string; // of the names of the fields
  at: LatLon | undefined;
}

/** Latitude and longitude; both may be pasted into one of them.  Text that is no number holds the form back. */
export function CoordinateFields({ label, prefix = "", at }: Props) {
  const isBad = useSignal(false);
  const [shownLat, shownLon] = at?.map((degrees) => Number(degrees.toFixed(9))) ?? [];
  const lat = useRef<HTMLInputElement>(null);
  const lon = useRef<HTMLInputElement>(null);
  const judge = (one: HTMLInputElement | null, axis: "lat" | "lon") => {
    const bad = one !== null && one.value.trim() !== "" && degreesIn(one.value, axis) === null;
    one?.setCustomValidity(bad ? t("site.bad_coordinate") : "");
    return bad;
  };
  const judgeBoth = () => {
    const bad = [judge(lat.current, "lat"), judge(lon.current, "lon")];
    isBad.value = bad.includes(true);
  };
  const fill = (text: string): boolean => {
    const found = coordinatesIn(text);
    if (found === null || lat.current === null || lon.current === null) return false;
    [lat.current.value, lon.current.value] = [String(found[0]), String(found[1])];
    judgeBoth();
    return true;
  };
  const paste = (event: ClipboardEvent) => {
    if (!fill(event.clipboardData?.getData("text") ?? "")) return;
    event.preventDefault();
    event.currentTarget?.dispatchEvent(new Event("input", { bubbles: true })); // the form has changed
  };
  const end = ({ currentTarget }: Event) => {
    if (!fill((currentTarget as HTMLInputElement).value)) judgeBoth();
  };
  const begin = ({ currentTarget }: Event) => {
    (currentTarget as HTMLInputElement).setCustomValidity("");
    isBad.value = false;
  };
  const shared = { inputMode: "decimal", required: true, onPaste: paste, onChange: end, onInput: begin } as const;
  return (
    <>
      <label>
        {label}
        <input key={shownLat} ref={lat} name={`${prefix}lat`} defaultValue={shownLat} {...shared} />
      </label>
      <label>
        {t("site.longitude")}
        <input key={shownLon} ref={lon} name={`${prefix}lon`} defaultValue={shownLon} {...shared} />
      </label>
      {isBad.value && (
        <p class="warned whole" role="alert">
          {t("site.bad_coordinate")}
        </p>
      )}
    </>
  );
}

/** What the fields of a submitted form have. */
export function coordinatesOf(given: Record<string, string>, prefix = ""): { lat_deg: number; lon_deg: number } {
  const degrees = (axis: "lat" | "lon") => degreesIn(given[prefix + axis] ?? "", axis) ?? NaN;
  return { lat_deg: degrees("lat"), lon_deg: degrees("lon") };
}
