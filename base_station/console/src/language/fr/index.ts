import type { Catalogue } from "../catalogue";
import { display, language_name, shortcut } from "./display";
import { measure } from "./measure";
import { activity, posture, mobility, link, heat, battery, member, worn } from "./member";
import { station, forwarder } from "./station";

export const fr: Catalogue = {
  activity,
  battery,
  display,
  forwarder,
  heat,
  language_name,
  link,
  measure,
  member,
  mobility,
  posture,
  shortcut,
  station,
  worn,
};
