/** Change of the incident on the screen. */
import { selectedUnit, find, floor } from "../uiState";
import type { Picture } from "../live/picture";
import { putDown } from "../plan/tools";

/** Clears the state of the previous site: the chosen member, the floor, a tool on the plan. */
export function showIncident(picture: Picture, incidentId: string): void {
  if (picture.incident.peek()?.incident_id === incidentId) return;
  putDown();
  selectedUnit.value = null;
  floor.value = "all";
  picture.choose(incidentId);
}

/** A unit on the plan, of whatever incident it is. */
export function showUnit(picture: Picture, unitId: string): void {
  const other = picture.otherIncidentOf(unitId);
  if (other !== null) showIncident(picture, other.incident_id);
  find(unitId, picture.unit(unitId)?.peek().position?.floor ?? null);
}
