/** Routes to a member who is down, requested while they are shown, and the guided rescuer. */
import { signal } from "@preact/signals";
import * as api from "../api";
import type { UnitView } from "../wire";
import { compareNames, length } from "../language/measures";
import { t } from "../language/translate";
import { routeText } from "./routeText";
import { displayName } from "./urgency";

/** Routes to one member as last answered, and the rescuer whose route is drawn. */
export interface Rescue {
  unitId: string;
  rescuerId: string | null; // who was chosen; null: nobody yet
  routes: readonly api.Route[]; // the nearest first; of who was chosen it may be a fourth one
  guides: readonly api.Guide[];
  fault: string; // for a person: why there are none; empty: there are
}

export const rescue = signal<Rescue | null>(null);

const AGAIN_MS = 2_000;
/** Prefix of the name of the rapid intervention crew, as set under *People*. */
const RIC = /^(RIC|RIT)\b/i;

/** Requests the routes to a member periodically until the returned function is called. */
export function followRescue(unitId: string): () => void {
  rescue.value = { unitId, rescuerId: null, routes: [], guides: [], fault: "" };
  let asking = false;
  const again = () => {
    if (asking) return;
    asking = true;
    void ask(unitId).finally(() => (asking = false));
  };
  again();
  const timer = window.setInterval(again, AGAIN_MS);
  return () => {
    clearInterval(timer);
    if (rescue.peek()?.unitId === unitId) rescue.value = null;
  };
}

/** Shows the route of another rescuer. */
export function chooseRescuer(rescuerId: string | null): void {
  const now = rescue.peek();
  if (now === null) return;
  rescue.value = { ...now, rescuerId };
  void ask(now.unitId);
}

/** After something was done. */
export function askAgain(): void {
  const now = rescue.peek();
  if (now !== null) void ask(now.unitId);
}

async function ask(unitId: string): Promise<void> {
  const chosen = rescue.peek()?.rescuerId ?? null;
  try {
    const [nearest, guides] = await Promise.all([api.routes(unitId), api.guides()]);
    const isListed = chosen === null || nearest.some((one) => one.unit_id === chosen);
    const other = isListed ? [] : await api.routes(unitId, chosen);
    say(unitId, { routes: [...nearest, ...other], guides, fault: "" }, chosen);
  } catch (error) {
    const fault = error instanceof Error ? error.message : String(error);
    say(unitId, { routes: [], fault }, chosen);
  }
}

/** Unless another member is shown by now. */
function say(unitId: string, answer: Partial<Rescue>, chosen: string | null): void {
  const now = rescue.peek();
  if (now?.unitId === unitId && now.rescuerId === chosen) rescue.value = { ...now, ...answer };
}

/** The drawn route: of the chosen rescuer, or of the nearest. */
export function drawnRoute({ routes, rescuerId }: Rescue): api.Route | null {
  return routes.find((one) => one.unit_id === rescuerId) ?? routes[0] ?? null;
}

/** "14 m to the stairs, up one floor, left, 9 m", or the length of a straight line without a known route. */
export function routeWords(route: api.Route): string {
  const words = routeText(route);
  return route.crosses_walls ? t("route.crosses_walls", { route: words }) : words;
}

/** "38 m ± 4 m"; the walking distance of a straight line is unknown. */
export function wayWords({ known, distance_m, uncertainty_m }: api.Route): string {
  const words = t("route.length", {
    distance: length(distance_m, 0),
    uncertainty: length(Math.max(1, uncertainty_m), 0),
  });
  return known ? words : t("route.straight_line", { length: words });
}

/** Members of the rapid intervention crew who are no casualties. */
export function ricOf(units: readonly UnitView[], unitId: string): UnitView[] {
  return units.filter((unit) => unit.unit_id !== unitId && RIC.test(unit.person?.crew ?? ""));
}

/** The other possible rescuers, sorted by name. */
export function others(units: readonly UnitView[], unitId: string): UnitView[] {
  return units
    .filter((unit) => unit.unit_id !== unitId && unit.registered)
    .filter((unit) => unit.person !== null && unit.position !== null)
    .sort((a, b) => compareNames(displayName(a), displayName(b)));
}
