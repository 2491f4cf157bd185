/** Files from elsewhere in an incident, as the station keeps them. */
import type * as answers from "./answers";
import { BASE, call, id } from "./http";

export type ImportedFile = answers.ImportAnswer;
export type ImportedTracks = answers.ImportedTracks;

/** The longest name that the station takes. */
const MOST_NAME = 80;

/** Known offset of the clock that made a file. */
export interface ClockOfFile {
  shift_s: number;
  utc_offset_h: number | null;
}

const path = (incidentId: string) => `/incidents/${id(incidentId)}/imports`;

export const importedFiles = (incidentId: string) => call<ImportedFile[]>("GET", path(incidentId));
export const importedTracks = (incidentId: string, importId: string) =>
  call<ImportedTracks>("GET", `${path(incidentId)}/${id(importId)}/tracks`);
/** The same file again changes nothing. */
export const importFile = (incidentId: string, file: File, clock: ClockOfFile) => {
  const offset = clock.utc_offset_h === null ? "" : `&utc_offset_h=${clock.utc_offset_h}`;
  const query = `?file_name=${id(file.name.slice(-MOST_NAME))}&shift_s=${clock.shift_s}${offset}`;
  const body = new Blob([file], { type: "application/octet-stream" });
  return call<ImportedFile>("POST", path(incidentId) + query, body);
};
export const removeImport = (incidentId: string, importId: string) =>
  call<void>("DELETE", `${path(incidentId)}/${id(importId)}`);
/** The original file. */
export const fileAddress = (incidentId: string, importId: string) =>
  `${BASE}${path(incidentId)}/${id(importId)}/file`;
