import { attempt, live } from "../sessions";
import { openDialog } from "../uiState";
import * as api from "../api";
import { take } from "../plan/tools";
import { current, lastLocate } from "../live/commands";
import { displayName } from "../live/urgency";
import { confirmPar } from "../undo";
import type { UnitView } from "../wire";
import { t } from "../language/translate";
import { ByRadio } from "./ByRadio";

/** Actions for one person; only on the chosen card, so that cards stay calm. */
export function CardActions({ unit }: { unit: UnitView }) {
  const { unit_id: unitId, duty } = unit;
  const name = displayName(unit);
  const resting = duty !== null && duty.rest_since_ms !== null;
  const incidentId = incidentFor(unitId);
  return (
    <div class="card-actions" role="group" aria-label={t("card.actions", { name })}>
      {incidentId !== null && (
        <button
          type="button"
          class="primary"
          onClick={() => void attempt(api.assignMembers(incidentId, { unit_id: unitId }))}
        >
          {t("card.assign_incident")}
        </button>
      )}
      {duty !== null && (
        <>
          <ByRadio
            label={t("card.par_by_radio")}
            members={[unit]}
            question={t("card.has_answered", { name })}
            kind="primary"
            onConfirm={() => void confirmPar({ unit_id: unitId }, name)}
          />
          <button type="button" onClick={() => void attempt(api.setRest(unitId, !resting))}>
            {t(resting ? "card.return_to_duty" : "card.to_rehab")}
          </button>
        </>
      )}
      <button type="button" onClick={() => take({ kind: "pin", unitId })}>
        {t("card.correct_position")}
      </button>
      <button type="button" onClick={() => take({ kind: "meeting", unitId })}>
        {t("card.same_place")}
      </button>
      <Locate unit={unit} />
      <button type="button" onClick={() => openDialog("text", unitId)}>
        {t("card.message")}
      </button>
    </div>
  );
}

/** The incident that is shown, where the unit is of none; else null. */
function incidentFor(unitId: string): string | null {
  const shown = live.value?.picture;
  if (shown === undefined || shown.choices.value.length === 0 || shown.isShown(unitId)) return null;
  return shown.incident.value?.incident_id ?? null;
}

/** Stops an active signal; asks first where the unit has no output for it. */
function Locate({ unit: { unit_id: unitId, can_be_notified } }: { unit: UnitView }) {
  const picture = live.value?.picture;
  const commands = picture ? current(picture.commands.value.values(), picture.incident.value) : [];
  const located = lastLocate(unitId, commands)?.command;
  if (located?.open) {
    return (
      <button type="button" onClick={() => void attempt(api.stopCommand(located.command_id))}>
        {t("order.stop_locate")}
      </button>
    );
  }
  if (can_be_notified === false) {
    return (
      <button type="button" onClick={() => openDialog("locate", unitId)}>
        {t("card.locate_asks")}
      </button>
    );
  }
  return (
    <button
      type="button"
      title={t("order.locate_hint")}
      onClick={() => void attempt(api.sendCommand("locate", { unit_id: unitId }, ""))}
    >
      {t("card.locate")}
    </button>
  );
}
