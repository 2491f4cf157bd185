export type * from "./unit";
export type * from "./incident";
export type * from "./site";
export type * from "./station";
export type * from "./message";
