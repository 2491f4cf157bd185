import { useComputed, useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { wall } from "../appearance";
import { clockTime, shortFloor } from "../format";
import { headcountOf } from "../live/headcount";
import type { Picture } from "../live/picture";
import { arrange, displayName, urgencyOf, type Place } from "../live/urgency";
import type { UnitView } from "../wire";
import { t } from "../language/translate";
import { Icon } from "./Icon";
import { whatOrWhere } from "./Line";
import { ParClock } from "./ParClock";

/** For a screen on a wall, read from 2 m: names, state and floor, members in need of help first. */
export function Wall({ picture }: { picture: Picture }) {
  const second = useComputed(() => Math.floor(picture.nowMs.value / 1000));
  void [picture.unitsChanged.value, picture.alarms.value, second.value];
  const list = useRef<HTMLUListElement>(null);
  const room = useRoom(list);
  const units = picture.allUnits();
  const places = arrange([], [...units, ...inNeedElsewhere(picture)], picture.alarms.value, picture.nowMs.peek(), false);
  const counts = headcountOf(units);
  const left = places.slice(room);
  return (
    <main class="wall">
      <header>
        <h1>{picture.incident.value?.name ?? t("wall.no_incident")}</h1>
        <span>{t("wall.inside", { count: counts.parts.inside })}</span>
        <ParClock picture={picture} />
        <time>{clockTime(picture.nowMs.value)}</time>
        <button type="button" onClick={() => (wall.value = "off")}>
          {t("wall.leave")}
        </button>
      </header>
      <ul class="wall-people" ref={list} aria-label={t("wall.people")}>
        {places.slice(0, room).map((place) => (
          <Row key={place.unitId} place={place} picture={picture} />
        ))}
      </ul>
      {left.length > 0 && <p class="wall-more">{moreWords(left)}</p>}
    </main>
  );
}

function Row({ place, picture }: { place: Place; picture: Picture }) {
  const unit = picture.unit(place.unitId)?.value;
  if (unit === undefined) return null;
  const urgent = place.urgency === "immediate" || place.urgency === "soon";
  return (
    <li class={place.urgency}>
      {urgent && <Icon name="alarm" />}
      <span class="wall-name">{displayName(unit)}</span>
      <span class="wall-words">{wordsOf(unit, picture)}</span>
      <span class="wall-floor">{floorOf(unit)}</span>
    </li>
  );
}

/** Members of other incidents who need help: this screen has no list of alarms. */
function inNeedElsewhere(picture: Picture): UnitView[] {
  const others = picture.unitsOfAll().filter(({ unit_id }) => !picture.isShown(unit_id));
  return others.filter((unit) => ["immediate", "soon"].includes(urgencyOf(unit, picture.alarms.value)));
}

/** The problem; for another site the incident in place of the position. */
function wordsOf(unit: UnitView, picture: Picture): string {
  if (picture.isShown(unit.unit_id)) return whatOrWhere(unit, picture);
  const name = picture.otherIncidentOf(unit.unit_id)?.name ?? t("wall.unassigned");
  return t("wall.elsewhere", { incident: name, words: whatOrWhere(unit, picture) });
}

function floorOf({ position }: UnitView): string {
  return position === null || position.floor === null ? "?" : shortFloor(position.floor);
}

/** Members without room on the wall; the most urgent ones are above. */
function moreWords(left: readonly Place[]): string {
  const inNeed = left.filter(({ urgency }) => urgency !== "normal").length;
  const count = left.length;
  return inNeed === 0 ? t("wall.more_well", { count }) : t("wall.more", { count, needing: inNeed });
}

/** How many rows there is room for. */
function useRoom(list: { current: HTMLUListElement | null }): number {
  const room = useSignal(0);
  useEffect(() => {
    const box = list.current;
    if (box === null) return undefined;
    const read = () => {
      const style = getComputedStyle(box);
      const columns = style.gridTemplateColumns.split(" ").length;
      const rowPx = ROW_LINES * parseFloat(style.fontSize) + ROW_EDGES_PX;
      room.value = columns * Math.max(1, Math.floor((box.clientHeight - EDGES_PX) / rowPx));
    };
    const watch = new ResizeObserver(read);
    watch.observe(box);
    read();
    return () => watch.disconnect();
  }, []);
  return room.value;
}

const ROW_LINES = 1.15; // as in wall.css
const ROW_EDGES_PX = 18; // of a row, with the gap below it
const EDGES_PX = 16; // of the list
