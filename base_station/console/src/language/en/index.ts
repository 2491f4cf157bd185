/** English: the catalogue that the others are measured by. */
import { alarm_text, alarm_label, tracker_reason, fix_fault, alarm_subject, alarm_now } from "./alarm_texts";
import { display, language_name, shortcut } from "./display";
import { measure } from "./measure";
import { activity, posture, mobility, link, heat, battery, member, worn } from "./member";
import { station, forwarder } from "./station";

export const en = {
  activity,
  alarm_text,
  alarm_label,
  tracker_reason,
  fix_fault,
  alarm_subject,
  alarm_now,
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
