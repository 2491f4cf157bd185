/** Texts that nobody sees at the start, in English: fetched when the page is shown. */
export * from "./assessment_reasons";
export * from "./connection_reasons";
export * from "./dispatch_warnings";
export * from "./drawing_notes";
export * from "./field_labels";
export * from "./import_warnings";
export * from "./pin_reasons";
export * from "./refusals_access";
export * from "./refusals_form";
export * from "./refusals_incident";
export * from "./refusals_past";
export * from "./refusals_people";
export * from "./refusals_plan";
export * from "./refusals_station";
export * from "./rehearsals";
export * from "./transfer_problems";
export * from "./unit_checks";
