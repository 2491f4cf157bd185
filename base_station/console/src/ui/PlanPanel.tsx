import { useSignalEffect } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { centring, select, selectedUnit } from "../view";
import type { Picture } from "../live/picture";
import { follow } from "../plan/follow";
import { PlanMap } from "../plan/map";
import { siteCoordinate } from "../plan/site";
import { Floors } from "./Floors";

export function PlanPanel({ picture }: { picture: Picture }) {
  const target = useRef<HTMLDivElement>(null);
  const map = useRef<PlanMap | null>(null);

  useEffect(() => {
    if (target.current === null) return undefined;
    const made = new PlanMap(target.current, (unitId) => select(unitId, null));
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
    const position = picture.unit(selectedUnit.peek() ?? "")?.peek().position;
    if (position) map.current?.centre(siteCoordinate(position));
  });

  return (
    <section class="plan" aria-label="Plan">
      <Floors picture={picture} />
      <div
        class="map"
        ref={target}
        tabIndex={0}
        role="application"
        aria-label="Plan of the site. The list of people says the same in words."
      />
      <div class="zoom">
        <button type="button" aria-label="Zoom in" onClick={() => map.current?.zoom(1)}>
          +
        </button>
        <button type="button" aria-label="Zoom out" onClick={() => map.current?.zoom(-1)}>
          −
        </button>
        <button type="button" onClick={() => map.current?.fit()}>
          Fit
        </button>
      </div>
      <div class="north" aria-hidden="true">
        N
      </div>
    </section>
  );
}
