import { useLayoutEffect } from "preact/hooks";
import { mayAct } from "../sessions";
import type { Picture } from "../live/picture";
import { loadingKinds, shownKinds, toggle, type TrailKind } from "../plan/pastTrails";
import { putDown, take, tool } from "../plan/tools";
import { AnchorPanel } from "./AnchorPanel";
import { BeaconPanel } from "./BeaconPanel";
import { PinList } from "./PinList";
import { MeetingPanel, PinPanel, StartPanel } from "./PinPanel";

/** What can be done on the plan, and the panel of what is being done. */
export function PlanTools({ picture }: { picture: Picture }) {
  const now = tool.value;
  useLayoutEffect(() => {
    if (now === null) return undefined;
    const leave = (event: KeyboardEvent) => {
      if (event.key === "Escape") putDown();
    };
    document.addEventListener("keydown", leave);
    return () => document.removeEventListener("keydown", leave);
  }, [now]);
  return (
    <>
      <div class="plan-tools">
        {now === null && <Buttons />}
        <Trails />
        <PinList picture={picture} />
      </div>
      {now !== null && mayAct.value && <Panel picture={picture} />}
    </>
  );
}

function Buttons() {
  if (!mayAct.value) return null;
  return (
    <div class="tool-buttons" role="group" aria-label="On the plan">
      <button
        type="button"
        title="Everybody began here"
        onClick={() => take({ kind: "start" })}
      >
        All start here
      </button>
      <button type="button" onClick={() => take({ kind: "beacon" })}>
        Beacon
      </button>
    </div>
  );
}

function Panel({ picture }: { picture: Picture }) {
  const now = tool.value;
  switch (now?.kind) {
    case "pin":
      return <PinPanel key={now.unitId} picture={picture} unitId={now.unitId} pin={null} />;
    case "edit-pin": {
      const pin = picture.pins.value.find((one) => one.pin_id === now.pinId);
      if (pin === undefined) return null;
      return <PinPanel key={pin.pin_id} picture={picture} unitId={pin.unit_id} pin={pin} />;
    }
    case "start":
      return <StartPanel picture={picture} />;
    case "meeting":
      return <MeetingPanel picture={picture} unitId={now.unitId} />;
    case "beacon":
      return <BeaconPanel picture={picture} beacon={null} />;
    case "edit-beacon": {
      const beacon = picture.beacons.value.find((one) => one.beacon_id === now.beaconId);
      if (beacon === undefined) return null;
      return <BeaconPanel key={beacon.beacon_id} picture={picture} beacon={beacon} />;
    }
    case "anchor":
      return <AnchorPanel picture={picture} />;
    default:
      return null;
  }
}

const KINDS: readonly [TrailKind, string][] = [
  ["fused", "As shown at the time"],
  ["raw", "The unit’s own path"],
  ["smoothed", "Best known since"],
];

/** Which trails are drawn, with the lines they are drawn in. */
function Trails() {
  return (
    <details class="trails">
      <summary>Trails</summary>
      {KINDS.map(([kind, word]) => (
        <label key={kind}>
          <input
            type="checkbox"
            checked={shownKinds.value.has(kind)}
            onChange={() => toggle(kind)}
          />
          <span class={`trail-line ${kind}`} aria-hidden="true" />
          {word}
          {loadingKinds.value.has(kind) && <small> is worked out …</small>}
        </label>
      ))}
    </details>
  );
}
