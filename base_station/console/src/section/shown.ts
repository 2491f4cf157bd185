/** Whether this browser shows the side section, and along which axis. */
import { kept, keptSwitch } from "../kept";
import { AXES } from "./axis";

export const section = keptSwitch("muster-section", "off");
export const axis = kept("muster-section-axis", AXES, "longest");

export function toggleSection(): void {
  section.value = section.peek() === "on" ? "off" : "on";
}
