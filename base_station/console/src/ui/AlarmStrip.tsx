import { useSignal } from "@preact/signals";
import type { RefObject } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { isPast } from "../sessions";
import { openDialog } from "../uiState";
import { alarmRows, singleRows, type AlarmRow } from "../live/alarmRows";
import type { Picture } from "../live/picture";
import { t } from "../language/translate";
import { AlarmRowView } from "./AlarmRow";
import { ErrorBoundary } from "./ErrorBoundary";
import { SoundButton } from "./SoundButton";

/** A zone of fixed height: nothing below it moves when alarms come and go.  Alarms without room are
 * listed over the page on request, one row an alarm. */
export function AlarmStrip({ picture }: { picture: Picture }) {
  const open = picture.openAlarms.value;
  const rows = alarmRows(open, (unitId) => picture.otherIncidentOf(unitId)?.incident_id ?? "");
  const zone = useRef<HTMLDivElement>(null);
  const room = useRoom(zone);
  const isListed = useSignal(false);
  const hidden = Math.max(0, rows.length - room);
  const listed = isListed.value && open.length > 0;
  const close = () => (isListed.value = false);
  return (
    <section
      class="alarms"
      aria-label={t("alarm.open")}
      onKeyDown={({ key }) => key === "Escape" && close()}
    >
      <div class="alarms-head">
        <h2>{open.length === 0 ? t("alarm.none_open") : t("alarm.count_open", { count: open.length })}</h2>
        {(listed || hidden > 0 || open.length > rows.length) && (
          <button
            type="button"
            class={`more ${hidden > 0 ? "hides" : ""}`}
            aria-expanded={listed}
            onClick={() => (isListed.value = !listed)}
          >
            {listed ? t("alarm.fewer") : hidden > 0 ? t("alarm.more", { count: hidden }) : t("alarm.one_by_one")}
          </button>
        )}
        <button type="button" aria-keyshortcuts="A" onClick={() => openDialog("alarms")}>
          {t("alarm_list.open_list")}
        </button>
        {!isPast.value && <SoundButton />}
      </div>
      <div class="alarm-room" ref={zone}>
        <Rows
          key={listed ? "listed" : "zone"} // a listed alarm is not announced again
          rows={listed ? singleRows(open) : rows.slice(0, room)}
          kind={listed ? "listed" : "zone"}
          picture={picture}
          onFlood={() => (isListed.value = true)}
        />
      </div>
    </section>
  );
}

interface RowsProps {
  rows: readonly AlarmRow[];
  kind: "zone" | "listed";
  picture: Picture;
  onFlood: () => void;
}

function Rows({ rows, kind, picture, onFlood }: RowsProps) {
  return (
    <ul class={kind} aria-live="assertive" aria-relevant="additions">
      {rows.map((row, place) => (
        <ErrorBoundary as="li" key={row.key} what={t("alarm.row", { text: row.alarms[0]?.text ?? "" })}>
          <AlarmRowView row={row} place={place} picture={picture} onFlood={onFlood} />
        </ErrorBoundary>
      ))}
    </ul>
  );
}

/** How many rows the zone has room for: `--alarm-rows` of the style sheet, by the size of the screen. */
function useRoom(zone: RefObject<HTMLElement | null>): number {
  const room = useSignal(Infinity);
  useEffect(() => {
    const box = zone.current;
    if (box === null) return undefined;
    const read = () => (room.value = Number(getComputedStyle(box).getPropertyValue("--alarm-rows")));
    const watch = new ResizeObserver(read);
    watch.observe(box);
    read();
    return () => watch.disconnect();
  }, []);
  return room.value;
}
