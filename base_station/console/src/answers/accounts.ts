/** Requests and answers about login, users and tokens.
 *
 * Generated from the OpenAPI document of the station, which describes every field; after a change
 * there run `python -m tests.rig.console_types`.
 */

export interface Credentials {
  username: string;
  password: string;
}

export interface Me {
  username: string;
  role: string;
  must_change_password: boolean;
}

export interface NewToken {
  name: string;
  role: "viewer" | "commander" | "administrator";
  scopes?: Scope[];
  days?: number | null;
}

export interface NewUser {
  username: string;
  password: string;
  role: "viewer" | "commander" | "administrator";
}

export interface PasswordChange {
  old_password: string;
  new_password: string;
}

export type Scope = "accountability" | "alarms" | "assignments" | "audit" | "commands" | "dispatch" | "enrolments" | "exports" | "forgetting" | "health" | "incidents" | "live" | "people" | "pins" | "radio" | "recordings" | "replays" | "samples" | "site" | "standby" | "tokens" | "tracks" | "units" | "users";

export interface ShownTicket {
  ticket: string;
}

export interface Ticket {
  ticket: string;
  lasts_s: number;
}

export interface Token {
  token_id: string;
  name: string;
  role: string;
  scopes: string[];
  created_ms: number;
  expires_ms: number | null;
}

export interface TokenSecret {
  token_id: string;
  token: string;
}

export interface UserAnswer {
  username: string;
  role: string;
  created_ms: number;
  sessions: number;
}

export interface UserChange {
  password?: string | null;
  role?: "viewer" | "commander" | "administrator" | null;
}
