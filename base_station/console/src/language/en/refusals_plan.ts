/** Refusals about plans, drawings and maps, by their codes. */
export const refusal_plan = {
  "base-map-none":
    "There is no base map.",
  "base-map-unknown":
    "There is no such base map.",
  "drawing-no-wall":
    "the drawing has no line that could be a wall",
  "drawing-too-fine":
    "the drawing has more than {most} points; leave out furniture and hatching",
  "drawing-took-too-long":
    "the drawing took too long to be read; send a part of it",
  "drawing-unknown":
    "this file is no drawing that can be read; send {kinds}",
  "drawing-unreadable":
    "the drawing cannot be read; save it anew, or as a PNG, and send that",
  "dxf-library-missing":
    "the library ezdxf, which reads DXF, is not installed at the station: pip install --require-hashes -r deploy/requirements-plans.lock; or print the drawing to PDF",
  "dxf-no-unit":
    "the DXF does not say in which unit of length it is drawn; choose it, and send it again",
  "dxf-no-wall":
    "the drawing has no line that could be a wall",
  "dxf-too-fine":
    "the DXF has more than {most} points; leave out furniture and hatching",
  "dxf-unreadable":
    "the DXF cannot be read; save it anew, or print it to PDF",
  "geojson-empty":
    "this GeoJSON has no line and no area",
  "geojson-no-collection":
    "{file} is no GeoJSON FeatureCollection",
  "geojson-no-json":
    "{file} is no JSON: {error}",
  "geojson-no-numbers":
    "this GeoJSON has coordinates that are no numbers",
  "geojson-not-degrees":
    "the coordinates of this GeoJSON are no degrees of longitude and latitude; save it in EPSG:4326",
  "ifc-contradictory":
    "the IFC has references that its schema does not allow; check it and save it anew, or print its floors to PDF",
  "ifc-library-missing":
    "the library ifcopenshell, which reads IFC, is not installed at the station: pip install --require-hashes -r deploy/requirements-ifc.lock; or export the floors as DXF, IMDF or PDF",
  "ifc-no-storey":
    "the IFC has no storeys (IfcBuildingStorey): export it with them, or print its floors to PDF",
  "ifc-no-wall":
    "the IFC has no wall with a shape on any of its storeys; print its floors to PDF",
  "ifc-too-detailed":
    "the IFC has too much detail; export walls, doors and stairs only",
  "ifc-torn":
    "the IFC is torn: its end is missing; copy or save it anew",
  "ifc-unreadable":
    "the IFC cannot be read; save it anew as IFC2x3, IFC4 or IFC4x3, or print its floors to PDF",
  "imdf-too-large":
    "this IMDF is larger than 60 MB; send one building of it",
  "map-too-many-bytes":
    "the map is larger than {most_mb}",
  "map-unreadable":
    "the map cannot be read; send a JPEG, PNG or WebP file",
  "pdf-encrypted":
    "the PDF is encrypted; save it without a password, and send that",
  "pdf-library-missing":
    "the library pypdfium2, which reads PDF, is not installed at the station: pip install --require-hashes -r deploy/requirements-plans.lock; or save the page as a PNG",
  "pdf-no-page":
    "the PDF has no page {page}: it has {pages}",
  "pdf-unreadable":
    "the PDF cannot be read; save the page as a PNG, and send that",
  "picture-is-line":
    "the picture has no more than a line of pixels",
  "picture-too-detailed":
    "the picture has too much detail for a plan; send one with fewer colours",
  "picture-unreadable":
    "the picture cannot be read; save it as PNG, JPEG or WebP",
  "plan-floor-twice":
    "the plan lists floor {floor} more than once",
  "plan-floor-without-height":
    "the plan has walls or stairs on floor {floor}, whose height is missing: “floors” of its member “muster” must list it with “down_m”",
  "plan-floors-unreadable":
    "the plan has a list of floors that cannot be read: {error}",
  "plan-name":
    "the plan’s name must be a string: “name” of its member “muster”",
  "plan-no-collection":
    "the plan is no GeoJSON FeatureCollection: {error}",
  "plan-no-json":
    "the plan is no JSON: {error}",
  "plan-no-scale":
    "the plan has no scale: “frame” of its member “muster” must be “site-m”, and coordinates must be [east_m, north_m] in metres",
  "plan-none":
    "There is no plan.",
  "plan-not-geojson":
    "the plan is no GeoJSON FeatureCollection",
  "plan-outlines-too-fine":
    "the plan’s outlines have {points} points: more than {most} are too many to look at for every position; draw them with fewer",
  "plan-stairs-too-many":
    "the plan has {stairs} stairs: more than {most}",
  "world-file-grid":
    "{grid} is none of the grids that a world file can be in: {known}",
  "world-file-makes-line":
    "the world file makes a line of the picture",
  "world-file-off-earth":
    "as {grid} the world file’s numbers lie nowhere on the Earth",
  "world-file-unfit":
    "a world file has six numbers, one a line",
  "zip-no-imdf":
    "this ZIP file is no IMDF: it has no level.geojson",
  "zip-unreadable":
    "this ZIP file cannot be read: {error}",
  "plan-not-sent-as-json":
    "send one JSON object as the body, with the header Content-Type: application/json",
  "ifc-zip-too-large":
    "the IFC in this ZIP file is larger than {most_mb}; export walls, doors, stairs and spaces only",
  "ifc-zip-unreadable":
    "this ZIP file cannot be read: {error}",
  "picture-too-large":
    "the picture has more than {most_million} million pixels; make it smaller",
  "drawing-size-unfit":
    "the drawing is {wide_m} wide: choose another unit of length, or send one building",
  "map-size-unfit":
    "the picture would be {wide_m} by {high_m} large; from {smallest_m} to {largest_m} make sense",
  "plan-walls-too-long":
    "the plan’s walls are {walls_m} long: more than {most_m} are in no building",
  "plan-feature-unreadable":
    "the plan’s feature {feature} cannot be read: {error}",
  "plan-ring-open":
    "the plan’s feature {feature} has a ring that is not closed: it must have at least {least} points, and the last must be the first (RFC 7946)",
  "plan-floor-unreadable":
    "the floor of the plan’s feature {feature} cannot be read: {error}",
  "plan-geometry-unfit":
    "the plan’s feature {feature} has the geometry {shape}: it must be one of {shapes}",
  "plan-points-too-few":
    "the plan’s feature {feature} has fewer than two points [east_m, north_m]",
  "plan-pictures-unreadable":
    "the plan has pictures that cannot be read: {error}",
  "plan-pictures-of-one-floor":
    "the plan has more than one picture of floor {floor}",
  "plan-pictures-too-large":
    "the plan’s pictures have more than {most_mb} together; send smaller ones, or fewer floors",
  "plan-picture-no-webp":
    "the plan’s picture of floor {floor} is no WebP in base64",
};
