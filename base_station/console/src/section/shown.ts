/** How this browser shows the building's height: the section instead of the plan, or not; from its side along
 * an axis, or its floors stacked. */
import { kept, keptSwitch } from "../kept";
import { AXES } from "./axis";

export const section = keptSwitch("muster-section", "off");
export const VIEWS = ["side", "stacked"] as const;
export const view = kept("muster-section-view", VIEWS, "side");
/** Of the stacked floors: heights are drawn so many times larger. */
export const SPREADS = ["1", "2", "3"] as const;
export type Spread = (typeof SPREADS)[number];
export const spread = kept<Spread>("muster-section-spread", SPREADS, "2");
export const axis = kept("muster-section-axis", AXES, "longest");

export function toggleSection(): void {
  section.value = section.peek() === "on" ? "off" : "on";
}
