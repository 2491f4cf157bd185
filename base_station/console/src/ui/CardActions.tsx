import { attempt } from "../sessions";
import { openDialog } from "../view";
import * as api from "../api";
import { take } from "../plan/tools";
import { displayName } from "../live/urgency";
import type { UnitView } from "../wire";

/** What can be done for one person; only on the card that was chosen, so that cards stay calm. */
export function CardActions({ unit }: { unit: UnitView }) {
  const { unit_id: unitId, duty } = unit;
  const resting = duty !== null && duty.rest_since_ms !== null;
  return (
    <div class="card-actions" role="group" aria-label={`For ${displayName(unit)}`}>
      {duty !== null && (
        <>
          <button
            type="button"
            class="primary"
            onClick={() => void attempt(api.checkIn({ unit_id: unitId }))}
          >
            Heard
          </button>
          <button type="button" onClick={() => void attempt(api.setRest(unitId, !resting))}>
            {resting ? "Back to work" : "To rest"}
          </button>
        </>
      )}
      <button type="button" onClick={() => take({ kind: "pin", unitId })}>
        Pin on the plan
      </button>
      <button type="button" onClick={() => take({ kind: "meeting", unitId })}>
        Met …
      </button>
      <button
        type="button"
        title="The unit makes itself heard and seen"
        onClick={() => void attempt(api.sendCommand("locate", { unit_id: unitId }, ""))}
      >
        Locate
      </button>
      <button type="button" onClick={() => openDialog("text", unitId)}>
        Message
      </button>
    </div>
  );
}
