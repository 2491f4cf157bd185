import { useSignal } from "@preact/signals";
import type { BaseMap, LatLon } from "../api";
import { earthAt } from "../plan/baseMap";
import { t } from "../language/translate";

const ZOOMS = [1, 2, 4, 8] as const;

interface MapPickerProps {
  map: BaseMap;
  /** Where points were put already. */
  marks: readonly LatLon[];
  pick(at: LatLon): void;
}

/** The base map for choosing latitude and longitude by a click. */
export function MapPicker({ map, marks, pick }: MapPickerProps) {
  const zoom = useSignal<number>(1);
  return (
    <div class="map-picker">
      <div class="map-picker-zoom" role="group" aria-label={t("map_picker.size")}>
        {ZOOMS.map((one) => (
          <button
            key={one}
            type="button"
            aria-pressed={zoom.value === one}
            onClick={() => (zoom.value = one)}
          >
            {one}×
          </button>
        ))}
      </div>
      <div class="map-picker-view" tabIndex={0} role="region" aria-label={t("map_picker.map")}>
        <div class="map-picker-sheet" style={{ width: `${100 * zoom.value}%` }}>
          <img
            src={map.image_url}
            alt={t("map_picker.image")}
            draggable={false}
            onClick={(event) => {
              const box = event.currentTarget.getBoundingClientRect();
              pick(
                earthAt(
                  map,
                  (event.clientX - box.left) / box.width,
                  (event.clientY - box.top) / box.height,
                ),
              );
            }}
          />
          {marks.map((at, index) => {
            const [across, down] = partsOf(map, at);
            return (
              <span
                key={index}
                class="map-picker-mark"
                style={{ left: `${100 * across}%`, top: `${100 * down}%` }}
              >
                {index + 1}
              </span>
            );
          })}
        </div>
      </div>
    </div>
  );
}

/** The inverse of `earthAt`. */
function partsOf(map: BaseMap, [lat, lon]: LatLon): [number, number] {
  const [a, c] = [map.upper_right[0] - map.upper_left[0], map.lower_left[0] - map.upper_left[0]];
  const [b, d] = [map.upper_right[1] - map.upper_left[1], map.lower_left[1] - map.upper_left[1]];
  const [x, y] = [lat - map.upper_left[0], lon - map.upper_left[1]];
  const whole = a * d - b * c;
  return [(x * d - y * c) / whole, (a * y - b * x) / whole];
}
