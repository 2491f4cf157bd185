/** Latitudes and longitudes as people write and paste them.  Pure. */

/** Both of "57.7, 11.9", "57,7; 11,9", "57,7 11,9", "57.7° N 11.9° E"; null: not both, or none on the Earth. */
export function coordinatesIn(text: string): [lat_deg: number, lon_deg: number] | null {
  const found = PAIRS.map((pair) => pair.exec(plain(text))).find((match) => match !== null);
  if (found === undefined) return null;
  const [, lat = "", north = "", lon = "", east = ""] = found;
  const pair = [degreesIn(lat + north, "lat"), degreesIn(lon + east, "lon")] as const;
  return pair[0] === null || pair[1] === null ? null : [pair[0], pair[1]];
}

const MOST_DEG = { lat: 90, lon: 180 };

/** One of them, with a decimal point or comma; null: none on the Earth. */
export function degreesIn(text: string, axis: "lat" | "lon"): number | null {
  const [, digits = "", way = ""] = /^([-+]?\d+(?:[.,]\d+)?)([NSEW]?)$/.exec(plain(text)) ?? [];
  const fits = way === "" || (axis === "lat" ? "NS" : "EW").includes(way);
  if (digits === "" || !fits) return null;
  const degrees = Number(digits.replace(",", ".")) * ("SW".includes(way || "-") ? -1 : 1);
  return Math.abs(degrees) <= MOST_DEG[axis] ? degrees : null;
}

const POINT = "([-+]?\\d+(?:\\.\\d+)?)([NSEW]?)";
const COMMA = "([-+]?\\d+(?:,\\d+)?)([NSEW]?)";
const CERTAIN_COMMA = "([-+]?\\d+,\\d+)([NSEW]?)";
/** "57,7" alone is one number. */
const PAIRS = [
  new RegExp(`^${POINT}(?:,? |;)${POINT}$`),
  new RegExp(`^(?=.*\\.)${POINT},${POINT}$`),
  new RegExp(`^${COMMA}(?:,? |;)${COMMA}$`),
  new RegExp(`^${CERTAIN_COMMA},${CERTAIN_COMMA}$`),
];

/** Without degree signs and needless spaces. */
function plain(text: string): string {
  return text
    .toUpperCase()
    .replaceAll("−", "-")
    .replaceAll("°", " ")
    .trim()
    .replace(/\s+/g, " ")
    .replace(/ (?=[NSEW,;])/g, "")
    .replaceAll("; ", ";");
}
