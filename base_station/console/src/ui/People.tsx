import { untracked, useComputed, useSignal, useSignalEffect } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { selectedUnit } from "../uiState";
import { grouped, sought, type Group } from "../live/finding";
import { headcountOf } from "../live/headcount";
import type { Picture } from "../live/picture";
import { guarded } from "../live/faults";
import { arrange, isCasualty, isJump, samePlaces, type Place } from "../live/urgency";
import { t } from "../language/translate";
import { Casualties } from "./Casualties";
import { CommandBar } from "./CommandBar";
import { ErrorBoundary } from "./ErrorBoundary";
import { Headcount } from "./Headcount";
import { ListTools } from "./ListTools";
import { finding, order, part, showAll, text } from "./listState";
import { PeopleGroups } from "./PeopleGroups";
import { Unassigned } from "./Unassigned";

/** With more members than this, those who are well get short cards, so that the others stand out. */
const MANY = 6;

/** A pointer that rests for longer does not hold the list: a member who was helped would stay in red. */
const HELD_MS = 10_000;

/** The list of people: those who need attention first, without jumps while it is read. */
export function People({ picture }: { picture: Picture }) {
  const held = useSignal(false);
  const movedMs = useRef(0); // the pointer
  const places = useSignal<readonly Place[]>([]);
  const down = useComputed(() => places.value.filter(isCasualty).map((place) => place.unitId));
  const second = useComputed(() => Math.floor(picture.nowMs.value / 1000));
  const counts = useComputed(() => {
    void [picture.unitIds.value, picture.incident.value, second.value];
    return headcountOf(picture.allUnits());
  });
  const seenMs = useRef(0);
  useSignalEffect(() => {
    void [picture.unitIds.value, picture.incident.value, picture.alarms.value, second.value, held.value];
    guarded(t("people_list.list"), () => untracked(() => {
      const nowMs = picture.nowMs.value;
      const before = isJump(seenMs.current, nowMs) ? [] : places.value;
      seenMs.current = nowMs;
      const isHeld = held.value && performance.now() - movedMs.current < HELD_MS;
      const next = arrange(before, picture.allUnits(), picture.alarms.value, nowMs, isHeld);
      if (!samePlaces(next, places.value)) places.value = next;
    }));
  });
  const list = useRef<HTMLDivElement>(null);
  useEffect(() => list.current?.scrollTo({ top: 0 }), [text.value]); // to who was found
  useEffect(() => showAll, [picture]); // a search does not carry over to another picture
  if (part.value !== null) void second.value; // people go in and out
  const shown = shownOf(places.value, picture);
  return (
    <section
      class="people"
      aria-label={t("people_list.title")}
      onPointerEnter={() => {
        movedMs.current = performance.now();
        held.value = true;
      }}
      onPointerMove={() => (movedMs.current = performance.now())}
      onPointerLeave={() => (held.value = false)}
    >
      <div class={`people-top ${finding.value ? "finding" : ""}`}>
        <div class="people-bar">
          <ErrorBoundary what={t("people_list.orders")}>
            <CommandBar picture={picture} />
          </ErrorBoundary>
          <button
            type="button"
            class="find"
            aria-expanded={finding.value}
            onClick={() => (finding.value = !finding.value)}
          >
            {t("people_list.find")}
          </button>
        </div>
        <ErrorBoundary what={t("people_list.headcount")}>
          <Headcount counts={counts} />
        </ErrorBoundary>
        <ErrorBoundary what={t("people_list.search")}>
          <ListTools />
        </ErrorBoundary>
        <LeftOut groups={shown} all={places.value.length} />
        <ErrorBoundary what={t("people_list.down")}>
          <Casualties unitIds={down.value} picture={picture} />
        </ErrorBoundary>
      </div>
      <div class="people-list" ref={list}>
        {places.value.length === 0 ? (
          <p class="nobody">
            {nobodyWords(picture)}
          </p>
        ) : (
          <PeopleGroups groups={shown} brief={places.value.length > MANY} picture={picture} />
        )}
        <Unassigned picture={picture} second={second} brief={places.value.length > MANY} />
      </div>
    </section>
  );
}

function nobodyWords(picture: Picture): string {
  if (!picture.ready.value) return t("people_list.waiting");
  if (picture.choices.value.length > 0) return t("people_list.nobody_in_incident");
  return t("people_list.none");
}

/** All of them where they cannot be sorted out. */
function shownOf(places: readonly Place[], picture: Picture): Group[] {
  let groups: Group[] = [{ crew: null, places, down: 0 }];
  guarded(t("people_list.list"), () => {
    const units = picture.allUnits();
    const always = isSought() ? selectedUnit.value : null; // who is chosen changes no whole list
    const found = sought(places, units, { text: text.value, part: part.value, always });
    groups = grouped(found, units, order.value);
  });
  return groups;
}

/** Whether the list is of some people only. */
function isSought(): boolean {
  return text.value.trim() !== "" || part.value !== null;
}

/** A searched list states that others are left out. */
function LeftOut({ groups, all }: { groups: readonly Group[]; all: number }) {
  const shown = groups.reduce((sum, group) => sum + group.places.length, 0);
  return (
    <div class="left-out" role="status">
      {isSought() && (
        <>
          <span>{t("people_list.shown", { shown, all })}</span>
          <button type="button" onClick={showAll}>
            {t("people_list.show_all")}
          </button>
        </>
      )}
    </div>
  );
}
