import type { Catalogue } from "../catalogue";
import { role, account, token, audit, scope, login } from "./account";
import { alarm_text, alarm_label, tracker_reason, fix_fault, alarm_subject, alarm_now } from "./alarm_texts";
import { alarm, closing } from "./alarms";
import { assessment } from "./assessment";
import { audit_action, audit_field, audit_value } from "./audit";
import { common } from "./common";
import { dispatch } from "./dispatch";
import { alarm_list, alarm_reason } from "./alarm_list";
import { display, language_name, shortcut } from "./display";
import { frame } from "./frame";
import { incident } from "./incidents";
import { imports } from "./imports";
import { measure } from "./measure";
import { activity, posture, mobility, link, heat, battery, member, worn, tracker } from "./member";
import { order, delivery } from "./orders";
import { board, radio, headcount, card, fact, list, par } from "./people";
import { anchor, base_map, beacon, plan, compass, trail, mark } from "./plan";
import { radio_audio } from "./radio_audio";
import { replay } from "./replay";
import { route } from "./rescue";
import { crew, enrolment, draft, erase } from "./setup";
import { station, forwarder, health, connection, systems } from "./station";

export const fr: Catalogue = {
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
  audit_action,
  audit_field,
  audit_value,
  base_map,
  alarm_list,
  alarm_reason,
  battery,
  beacon,
  board,
  card,
  closing,
  common,
  compass,
  connection,
  crew,
  delivery,
  dispatch,
  display,
  draft,
  enrolment,
  erase,
  fact,
  fix_fault,
  forwarder,
  frame,
  headcount,
  health,
  heat,
  imports,
  incident,
  language_name,
  link,
  list,
  login,
  mark,
  measure,
  member,
  mobility,
  order,
  par,
  plan,
  posture,
  radio,
  radio_audio,
  replay,
  role,
  route,
  scope,
  shortcut,
  station,
  systems,
  token,
  tracker,
  tracker_reason,
  trail,
  worn,
};
