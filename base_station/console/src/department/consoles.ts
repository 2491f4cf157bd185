/** Addresses of the stations' consoles. */
import type { DepartmentView } from "./answers";

/** Empty: the station has not reported it. */
export function consoleUrl(view: DepartmentView, station: string): string {
  return view.stations.find((one) => one.station === station)?.console_url ?? "";
}
