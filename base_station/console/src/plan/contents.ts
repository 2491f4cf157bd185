/** What a plan holds, in words.  Pure. */
import type { Plan } from "../wire";

/** "Mill Road 7: 2 floors, 12 rooms"; also of a file that the station may refuse as no plan. */
export function contents(plan: Partial<Plan>): string {
  const features = Array.isArray(plan.features) ? plan.features : [];
  const floors = plan.muster?.floors;
  const rooms = features.filter((one) => one?.properties?.["kind"] === "room");
  const counts = [
    many(Array.isArray(floors) ? floors.length : 0, "floor"),
    many(rooms.length, "room"),
    many(features.length, "shape"),
  ];
  return `${plan.muster?.name ?? "A plan without a name"}: ${counts.join(", ")}`;
}

function many(count: number, thing: string): string {
  return `${count} ${thing}${count === 1 ? "" : "s"}`;
}
