import { untracked, useComputed, useSignal, useSignalEffect } from "@preact/signals";
import { useRef } from "preact/hooks";
import type { Picture } from "../live/picture";
import { guarded } from "../live/faults";
import { arrange, isCasualty, isJump, samePlaces, type Place } from "../live/urgency";
import { Card } from "./Card";
import { Casualties } from "./Casualties";
import { CommandBar } from "./CommandBar";
import { ErrorBoundary } from "./ErrorBoundary";

/** With more than this, whoever is well is said in short, so that who is not is seen. */
const MANY = 6;

/** The list of people: who needs attention first, without jumping while somebody reads. */
export function People({ picture }: { picture: Picture }) {
  const held = useSignal(false);
  const places = useSignal<readonly Place[]>([]);
  const down = useComputed(() => places.value.filter(isCasualty).map((place) => place.unitId));
  const seenMs = useRef(0);
  const second = useComputed(() => Math.floor(picture.nowMs.value / 1000));
  useSignalEffect(() => {
    void [picture.unitIds.value, picture.alarms.value, second.value, held.value];
    guarded("The list of people", () => untracked(() => {
      const nowMs = picture.nowMs.value;
      const before = isJump(seenMs.current, nowMs) ? [] : places.value;
      seenMs.current = nowMs;
      const next = arrange(before, picture.allUnits(), picture.alarms.value, nowMs, held.value);
      if (!samePlaces(next, places.value)) places.value = next;
    }));
  });
  return (
    <section
      class="people"
      aria-label="People"
      onPointerEnter={() => (held.value = true)}
      onPointerLeave={() => (held.value = false)}
    >
      <div class="people-top">
        <ErrorBoundary what="The bar of orders">
          <CommandBar picture={picture} />
        </ErrorBoundary>
        <ErrorBoundary what="The members who are down">
          <Casualties unitIds={down.value} picture={picture} />
        </ErrorBoundary>
      </div>
      <div class="people-list">
        {places.value.length === 0 ? (
          <p class="nobody">
            {picture.ready.value
              ? "No unit has been heard yet. Each appears here by itself when it is switched on."
              : "Waiting for the station."}
          </p>
        ) : (
          <ul class="cards">
            {places.value.map((place) => (
              <ErrorBoundary as="li" key={place.unitId} what={`The card of ${place.name}`}>
                <Card
                  unitId={place.unitId}
                  urgency={place.urgency}
                  brief={places.value.length > MANY}
                  picture={picture}
                />
              </ErrorBoundary>
            ))}
          </ul>
        )}
      </div>
    </section>
  );
}
