import { useSignal, useSignalEffect, type Signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { attempt, mayAct, namedIncident } from "../sessions";
import { centring, pane, notice, select, selectedUnit } from "../uiState";
import * as api from "../api";
import type { Picture } from "../live/picture";
import type { EdgeMark } from "../plan/edges";
import { follow } from "../plan/follow";
import { PlanMap, type PlanEvents } from "../plan/map";
import type { Standing } from "../plan/pins";
import { siteCoordinate } from "../plan/site";
import { click, clicked, take, tool, wantsPlaces, type Place } from "../plan/tools";
import { section, view } from "../section/shown";
import { t } from "../language/translate";
import { Edges } from "./Edges";
import { Floors } from "./Floors";
import { ErrorBoundary } from "./ErrorBoundary";
import { PlanTools, ToolPanel } from "./PlanTools";
import { SideSection } from "./SideSection";
import { StackedFloors } from "./StackedFloors";

export function PlanPanel({ picture }: { picture: Picture }) {
  const target = useRef<HTMLDivElement>(null);
  const map = useRef<PlanMap | null>(null);
  const outside = useSignal<readonly EdgeMark[]>([]);

  useEffect(() => {
    if (target.current === null) return undefined;
    const made = new PlanMap(target.current, eventsOf(picture, outside));
    map.current = made;
    const stop = follow(made, picture);
    return () => {
      stop();
      made.close();
      map.current = null;
    };
  }, [picture]);

  useSignalEffect(() => {
    if (centring.value === 0) return;
    const unitId = selectedUnit.peek() ?? "";
    if (!picture.isShown(unitId)) return; // where it is, is of another ground
    const position = picture.unit(unitId)?.peek().position;
    if (position) map.current?.showNear(siteCoordinate(position));
  });

  // A tool that wants places needs the plan.
  const withSection = section.value === "on" && !wantsPlaces(tool.value);
  const isStacked = withSection && view.value === "stacked";
  const shown = isStacked ? "with-section stacked" : withSection ? "with-section" : "";
  return (
    <section class={`plan ${shown}`} aria-label={t("plan_view.title")}>
      <ErrorBoundary what={t("plan_view.tools")}>
        <PlanTools picture={picture} />
      </ErrorBoundary>
      <ErrorBoundary what={t("plan_view.floors")}>
        <Floors picture={picture} />
      </ErrorBoundary>
      <Damage picture={picture} />
      <div
        class={`map ${wantsPlaces(tool.value) ? "placing" : ""}`}
        ref={target}
        tabIndex={0}
        role="application"
        aria-label={t("plan_view.map")}
        aria-description={t("plan_view.keys")}
        onKeyDown={({ key }) => key === "Escape" && tool.peek() === null && backToCard()}
      />
      <div class="zoom">
        <button type="button" aria-label={t("plan_view.zoom_in")} onClick={() => map.current?.zoom(1)}>
          +
        </button>
        <button type="button" aria-label={t("plan_view.zoom_out")} onClick={() => map.current?.zoom(-1)}>
          −
        </button>
        <button type="button" onClick={() => map.current?.fit()}>
          {t("plan_view.fit")}
        </button>
      </div>
      <ErrorBoundary what={t("plan_view.edges")}>
        <Edges picture={picture} marks={outside} />
      </ErrorBoundary>
      <div class="north" aria-hidden="true">
        {t("plan_view.north")}
      </div>
      {withSection && (
        <ErrorBoundary what={t("section.title")}>
          {isStacked ? <StackedFloors picture={picture} /> : <SideSection picture={picture} />}
        </ErrorBoundary>
      )}
      <ErrorBoundary what={t("plan_view.tool")}>
        <ToolPanel picture={picture} />
      </ErrorBoundary>
    </section>
  );
}

/** Parts of the plan that the station could not read, and leaves out. */
function Damage({ picture }: { picture: Picture }) {
  const damage = picture.plan.value?.muster.damage ?? "";
  return damage === "" ? null : <p class="cannot-show plan-damage">{damage}.</p>;
}

/** Moves the focus to the card that led here, or that of the member chosen here. */
function backToCard(): void {
  pane.value = "people";
  requestAnimationFrame(() => document.querySelector<HTMLElement>(".chosen .card-head")?.focus());
}

function eventsOf(picture: Picture, outside: Signal<readonly EdgeMark[]>): PlanEvents {
  return {
    select: (unitId) => select(unitId, null),
    click(place) {
      if (!wantsPlaces(tool.peek())) return false;
      click(place);
      return true;
    },
    choose(standing) {
      if (!mayAct.peek()) return;
      if (standing.kind === "pin") take({ kind: "edit-pin", pinId: standing.id });
      else take({ kind: "edit-beacon", beaconId: standing.id });
    },
    moved: (standing, place) => void move(picture, standing, place),
    outside(marks) {
      if (JSON.stringify(marks) !== JSON.stringify(outside.peek())) outside.value = marks;
    },
  };
}

/** A pin or beacon was dragged to another place; after a refusal it returns. */
async function move(picture: Picture, standing: Standing, place: Place): Promise<void> {
  const done = mayAct.peek() ? await attempt(moved(picture, standing, place)) : null;
  if (done === null) picture.pins.value = [...picture.pins.peek()];
  else clicked.value = []; // a place that was clicked before is not where it stands now
}

function moved(picture: Picture, standing: Standing, place: Place): Promise<object | null> {
  const beacon = picture.beacons.peek().find((one) => one.beacon_id === standing.id);
  if (standing.kind === "beacon" && beacon !== undefined) {
    return api.placeBeacon({ beacon_id: beacon.beacon_id, ...place }, namedIncident());
  }
  const pin = picture.pins.peek().find((one) => one.pin_id === standing.id);
  if (pin === undefined || pin.kind !== "place") {
    notice.value = t("plan_view.of_start");
    return Promise.resolve(null);
  }
  return api.movePin(pin.pin_id, { unit_id: pin.unit_id, ...place });
}
