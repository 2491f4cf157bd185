import type { Catalogue } from "../catalogue";
import { role, account, token, audit, scope, login } from "./account";
import { alarm_list, alarm_reason } from "./alarm_list";
import { alarm_text, alarm_label, tracker_reason, fix_fault, alarm_subject, alarm_now } from "./alarm_texts";
import { alarm, closing } from "./alarms";
import { assessment } from "./assessment";
import { audit_action, audit_field, audit_value } from "./audit";
import { common } from "./common";
import { department } from "./department";
import { dispatch } from "./dispatch";
import { display, language_name, shortcut } from "./display";
import { frame } from "./frame";
import { imports } from "./imports";
import { incident } from "./incidents";
import { menu, open_replays, map_picker, recording, units, users, site } from "./manage";
import { measure } from "./measure";
import { activity, posture, mobility, link, heat, battery, member, worn, tracker } from "./member";
import { order, delivery } from "./orders";
import { past } from "./past";
import { board, radio, headcount, card, fact, list, confirmation } from "./people";
import { anchor, base_map, beacon, plan, compass, trail, mark } from "./plan";
import { plan_tools, plan_view, plan_form, drawing, pin, direction, section, stack } from "./plan_tools";
import { problem } from "./problems";
import { radio_audio } from "./radio_audio";
import { refusal_access } from "./refusals_access";
import { refusal_incident } from "./refusals_incident";
import { refusal_past } from "./refusals_past";
import { refusal_people } from "./refusals_people";
import { refusal_plan } from "./refusals_plan";
import { refusal_station } from "./refusals_station";
import { replay, transport, timeline, crossing } from "./replay";
import { route } from "./rescue";
import { people_list, person, people_import, par, rescue } from "./roster";
import { crew, enrolment, draft, erase } from "./setup";
import { station, forwarder, health, connection, systems, archive } from "./station";
import { coded_reason } from "./coded_reasons";
import { drawing_note } from "./drawing_notes";
import { unit_fault } from "./unit_faults";
import { sound, standby, away, waiting, wall } from "./stations";

export const de: Catalogue = {
  account,
  activity,
  alarm,
  alarm_label,
  alarm_list,
  alarm_now,
  alarm_reason,
  alarm_subject,
  alarm_text,
  anchor,
  assessment,
  audit,
  audit_action,
  audit_field,
  audit_value,
  away,
  base_map,
  battery,
  beacon,
  board,
  card,
  closing,
  common,
  compass,
  confirmation,
  connection,
  crew,
  crossing,
  delivery,
  department,
  direction,
  dispatch,
  display,
  draft,
  drawing,
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
  map_picker,
  mark,
  measure,
  member,
  menu,
  mobility,
  open_replays,
  order,
  par,
  past,
  people_import,
  people_list,
  person,
  pin,
  plan,
  plan_form,
  plan_tools,
  plan_view,
  posture,
  radio,
  problem,
  radio_audio,
  recording,
  refusal_access,
  refusal_incident,
  refusal_past,
  refusal_people,
  refusal_plan,
  refusal_station,
  replay,
  rescue,
  role,
  route,
  scope,
  shortcut,
  site,
  section,
  sound,
  stack,
  standby,
  station,
  systems,
  archive,
  timeline,
  unit_fault,
  coded_reason,
  drawing_note,
  token,
  tracker,
  tracker_reason,
  trail,
  transport,
  units,
  users,
  waiting,
  wall,
  worn,
};
