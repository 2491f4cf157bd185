/** Notes on a drawing that was read, by the codes of their sentences. */

export const drawing_note = {
  "note-columns": "columns",
  "note-doors": "doors",
  "note-dxf-no-walls": "No layer has the name of walls: every line is taken for one.",
  "note-dxf-unit": "Its unit of length is {unit}; it lies with its lower left corner at the origin.",
  "note-features-left-out":
    "{count, plural, one {# of its features is a point or of no use to a plan, and left out.} other {# of its features are points or of no use to a plan, and left out.}}",
  "note-floors": "Its floors: {floors}.",
  "note-left-out": "Left out are {elements}: {count, number}.",
  "note-lifts": "lifts",
  "note-no-class": "elements without a class",
  "note-no-passage": "{elements} without a door that are too small, or begin above the floor",
  "note-no-place": "It has no place on the Earth: align it by two points.",
  "note-no-walls": "It has no walls: rooms are drawn, and paths may cross them.",
  "note-not-cut": "{elements} not at {cut_m} above a floor",
  "note-openings": "openings",
  "note-other-grid": "Its place is given in the grid {grid}, not UTM.",
  "note-outside-zone": "Its place in {grid} lies outside of that zone.",
  "note-rooms": "rooms",
  "note-stairs": "stairs",
  "note-storeys-left-out": "Storeys without doors, rooms and stairs are left out: {names}.",
  "note-suggested":
    "Its place on the Earth is that of its site, which many drawing programs set by themselves: look at it before you use it.",
  "note-too-low": "{elements} lower than {steps_m}",
  "note-walls": "walls",
  "note-without-shape": "{elements} without a shape",
} as const;
