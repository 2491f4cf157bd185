/** Requests and answers about orders to units, and routes.
 *
 * Generated from the OpenAPI document of the station, which describes every field; after a change
 * there run `python -m tests.rig.console_types`.
 */
import type { CrewTarget, EveryoneTarget, FloorTarget, TextCodeView, UnitTarget } from "./common";

export interface AllClear {
  expires_s?: number;
}

export interface CommandView {
  command_id: string;
  kind: string;
  text: string;
  issued_by: string;
  issued_ms: number;
  expires_ms: number;
  asks_wearer: boolean;
  notifies_wearer: boolean;
  open: boolean;
  units: DeliveryView[];
  incident_id: string;
  ended_ms: number | null;
  ended_command_id: string;
}

export interface Confirmation {
  unit_id: string;
}

export interface DeliveryView {
  unit_id: string;
  state: string;
  sent_ms: number | null;
  received_ms: number | null;
  notified_ms: number | null;
  acknowledged_ms: number | null;
  acknowledged_by: string;
  reason: string;
  acknowledged_via: string;
  can_be_notified: boolean | null;
  repeated_ms: number | null;
  ended_ms: number | null;
  signal: string;
  reason_code: TextCodeView | null;
}

export interface GuideAnswer {
  rescuer_id: string;
  unit_id: string;
  by: string;
  text: string;
  sent_ms: number;
}

export interface GuideForm {
  rescuer_id: string;
}

export type Kind = "evacuate" | "par_request" | "text" | "locate" | "set_position_rate";

export interface NewCommand {
  kind: Kind;
  target: UnitTarget | CrewTarget | FloorTarget | EveryoneTarget;
  text?: string;
  position_rate_hz?: number;
  incident_id?: string | null;
  expires_s?: number;
}

export interface Repeat {
  unit_id?: string | null;
  expires_s?: number;
}

export interface RouteAnswer {
  unit_id: string;
  known: boolean;
  distance_m: number;
  uncertainty_m: number;
  crosses_walls: boolean;
  text: string;
  next_text: string;
  legs: RouteLegAnswer[];
  places: RoutePlace[];
}

export interface RouteLegAnswer {
  turn: "ahead" | "left" | "right" | "back" | null;
  bearing_rad: number;
  distance_m: number;
  floors: number;
}

export interface RoutePlace {
  north_m: number;
  east_m: number;
  floor: number | null;
}
