import type { Catalogue } from "../catalogue";
import { role, account, token, audit, scope } from "./account";
import { alarm_text, alarm_label, tracker_reason, fix_fault, alarm_subject, alarm_now } from "./alarm_texts";
import { alarm, closing } from "./alarms";
import { assessment } from "./assessment";
import { common } from "./common";
import { dispatch } from "./dispatch";
import { display, language_name, shortcut } from "./display";
import { frame } from "./frame";
import { incident } from "./incidents";
import { measure } from "./measure";
import { activity, posture, mobility, link, heat, battery, member, worn } from "./member";
import { order, delivery } from "./orders";
import { board, radio, headcount, card } from "./people";
import { anchor, base_map, beacon, plan, compass, trail } from "./plan";
import { crew, enrolment, draft, erase } from "./setup";
import { station, forwarder } from "./station";

export const de: Catalogue = {
  account,
  activity,
  alarm,
  alarm_label,
  alarm_now,
  alarm_subject,
  alarm_text,
  anchor,
  assessment,
  audit,
  base_map,
  battery,
  beacon,
  board,
  card,
  closing,
  common,
  compass,
  crew,
  delivery,
  dispatch,
  display,
  draft,
  enrolment,
  erase,
  fix_fault,
  forwarder,
  frame,
  headcount,
  heat,
  incident,
  language_name,
  link,
  measure,
  member,
  mobility,
  order,
  plan,
  posture,
  radio,
  role,
  scope,
  shortcut,
  station,
  token,
  tracker_reason,
  trail,
  worn,
};
