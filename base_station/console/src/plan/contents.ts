/** The content of a plan in words.  Pure. */
import type { Plan } from "../wire";
import { t } from "../language/translate";

/** "Mill Road 7: 2 floors, 12 rooms"; also of a file that the station may refuse as no plan. */
export function contents(plan: Partial<Plan>): string {
  const features = Array.isArray(plan.features) ? plan.features : [];
  const floors = plan.muster?.floors;
  const rooms = features.filter((one) => one?.properties?.["kind"] === "room");
  return t("plan.contents", {
    name: plan.muster?.name ?? t("plan.unnamed"),
    floors: Array.isArray(floors) ? floors.length : 0,
    rooms: rooms.length,
    shapes: features.length,
  });
}
