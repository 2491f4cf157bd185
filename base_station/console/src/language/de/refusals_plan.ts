/** Refusals about plans, drawings and maps, by their codes, in German. */
import type { Part } from "../catalogue";

export const refusal_plan: Part<"refusal_plan"> = {
  "base-map-none":
    "Es gibt keine Grundkarte.",
  "base-map-unknown":
    "Diese Grundkarte gibt es nicht.",
  "drawing-no-wall":
    "Die Zeichnung hat keine Linie, die eine Wand sein könnte",
  "drawing-too-fine":
    "Die Zeichnung hat mehr als {most} Punkte; lassen Sie Möbel und Schraffuren weg",
  "drawing-took-too-long":
    "Die Zeichnung zu lesen hat zu lange gedauert; senden Sie einen Teil davon",
  "drawing-unknown":
    "Diese Datei ist keine lesbare Zeichnung; senden Sie {kinds}",
  "drawing-unreadable":
    "Die Zeichnung ist nicht lesbar; speichern Sie sie neu oder als PNG, und senden Sie das",
  "dxf-library-missing":
    "Die Bibliothek ezdxf, die DXF liest, ist an der Station nicht installiert: pip install --require-hashes -r deploy/requirements-plans.lock; oder drucken Sie die Zeichnung als PDF",
  "dxf-no-unit":
    "Die DXF-Datei nennt nicht, in welcher Längeneinheit sie gezeichnet ist; wählen Sie diese, und senden Sie sie noch einmal",
  "dxf-no-wall":
    "Die Zeichnung hat keine Linie, die eine Wand sein könnte",
  "dxf-too-fine":
    "Die DXF-Datei hat mehr als {most} Punkte; lassen Sie Möbel und Schraffuren weg",
  "dxf-unreadable":
    "Die DXF-Datei ist nicht lesbar; speichern Sie sie neu, oder drucken Sie sie als PDF",
  "geojson-empty":
    "Dieses GeoJSON hat keine Linie und keine Fläche",
  "geojson-no-collection":
    "{file} ist keine GeoJSON-FeatureCollection",
  "geojson-no-json":
    "{file} ist kein JSON: {error}",
  "geojson-no-numbers":
    "Dieses GeoJSON hat Koordinaten, die keine Zahlen sind",
  "geojson-not-degrees":
    "Die Koordinaten dieses GeoJSON sind keine Grade von Länge und Breite; speichern Sie es in EPSG:4326",
  "ifc-contradictory":
    "Die IFC-Datei hat Verweise, die ihr Schema nicht erlaubt; prüfen und speichern Sie sie neu, oder drucken Sie ihre Geschosse als PDF",
  "ifc-library-missing":
    "Die Bibliothek ifcopenshell, die IFC liest, ist an der Station nicht installiert: pip install --require-hashes -r deploy/requirements-ifc.lock; oder exportieren Sie die Geschosse als DXF, IMDF oder PDF",
  "ifc-no-storey":
    "Die IFC-Datei hat keine Geschosse (IfcBuildingStorey): Exportieren Sie sie damit, oder drucken Sie ihre Geschosse als PDF",
  "ifc-no-wall":
    "Die IFC-Datei hat auf keinem Geschoss eine Wand mit einer Form; drucken Sie ihre Geschosse als PDF",
  "ifc-too-detailed":
    "Die IFC-Datei hat zu viele Einzelheiten; exportieren Sie nur Wände, Türen und Treppen",
  "ifc-torn":
    "Die IFC-Datei ist abgerissen: Ihr Ende fehlt; kopieren oder speichern Sie sie neu",
  "ifc-unreadable":
    "Die IFC-Datei ist nicht lesbar; speichern Sie sie neu als IFC2x3, IFC4 oder IFC4x3, oder drucken Sie ihre Geschosse als PDF",
  "imdf-too-large":
    "Dieses IMDF ist größer als 60 MB; senden Sie ein Gebäude daraus",
  "map-too-many-bytes":
    "Die Karte ist größer als {most_mb}",
  "map-unreadable":
    "Die Karte ist nicht lesbar; senden Sie eine Datei im Format JPEG, PNG oder WebP",
  "pdf-encrypted":
    "Das PDF ist verschlüsselt; speichern Sie es ohne Passwort, und senden Sie das",
  "pdf-library-missing":
    "Die Bibliothek pypdfium2, die PDF liest, ist an der Station nicht installiert: pip install --require-hashes -r deploy/requirements-plans.lock; oder speichern Sie die Seite als PNG",
  "pdf-no-page":
    "Das PDF hat keine Seite {page}: Es hat {pages}",
  "pdf-unreadable":
    "Das PDF ist nicht lesbar; speichern Sie die Seite als PNG, und senden Sie das",
  "picture-is-line":
    "Das Bild hat nicht mehr als eine Zeile von Pixeln",
  "picture-too-detailed":
    "Das Bild hat zu viele Einzelheiten für einen Plan; senden Sie eines mit weniger Farben",
  "picture-unreadable":
    "Das Bild ist nicht lesbar; speichern Sie es als PNG, JPEG oder WebP",
  "plan-floor-twice":
    "Der Plan nennt das Geschoss {floor} mehr als einmal",
  "plan-floor-without-height":
    "Der Plan hat Wände oder Treppen auf Geschoss {floor}, dessen Höhe fehlt: „floors“ unter „muster“ muss es mit „down_m“ nennen",
  "plan-floors-unreadable":
    "Die Liste der Geschosse des Plans ist nicht lesbar: {error}",
  "plan-name":
    "Der Name des Plans muss ein Text sein: „name“ unter „muster“",
  "plan-no-collection":
    "Der Plan ist keine GeoJSON-FeatureCollection: {error}",
  "plan-no-json":
    "Der Plan ist kein JSON: {error}",
  "plan-no-scale":
    "Der Plan hat keinen Maßstab: „frame“ unter „muster“ muss „site-m“ sein, und Koordinaten müssen [east_m, north_m] in Metern sein",
  "plan-none":
    "Es gibt keinen Plan.",
  "plan-not-geojson":
    "Der Plan ist keine GeoJSON-FeatureCollection",
  "plan-outlines-too-fine":
    "Die Umrisse des Plans haben {points} Punkte: Mehr als {most} sind zu viele, um sie für jede Position zu prüfen; zeichnen Sie sie mit weniger",
  "plan-stairs-too-many":
    "Der Plan hat {stairs} Treppen: mehr als {most}",
  "world-file-grid":
    "{grid} ist keines der Gitter, in denen eine World-Datei sein kann: {known}",
  "world-file-makes-line":
    "Die World-Datei macht aus dem Bild eine Linie",
  "world-file-off-earth":
    "In {grid} liegen die Zahlen der World-Datei nirgends auf der Erde",
  "world-file-unfit":
    "Eine World-Datei hat sechs Zahlen, eine je Zeile",
  "zip-no-imdf":
    "Diese ZIP-Datei ist kein IMDF: Sie hat kein level.geojson",
  "zip-unreadable":
    "Diese ZIP-Datei ist nicht lesbar: {error}",
  "plan-not-sent-as-json":
    "Senden Sie ein JSON-Objekt als Inhalt, mit dem Kopf Content-Type: application/json",
  "ifc-zip-too-large":
    "Das IFC in dieser ZIP-Datei ist größer als {most_mb}; exportieren Sie nur Wände, Türen, Treppen und Räume",
  "ifc-zip-unreadable":
    "Diese ZIP-Datei ist nicht lesbar: {error}",
  "picture-too-large":
    "Das Bild hat mehr als {most_million} Millionen Pixel; verkleinern Sie es",
  "drawing-size-unfit":
    "Die Zeichnung ist {wide_m} breit: Wählen Sie eine andere Längeneinheit, oder senden Sie ein einzelnes Gebäude",
  "map-size-unfit":
    "Das Bild wäre {wide_m} mal {high_m} groß; sinnvoll sind {smallest_m} bis {largest_m}",
  "plan-walls-too-long":
    "Die Wände des Plans sind {walls_m} lang: Mehr als {most_m} hat kein Gebäude",
  "plan-feature-unreadable":
    "Das Objekt {feature} des Plans ist nicht lesbar: {error}",
  "plan-ring-open":
    "Das Objekt {feature} des Plans hat einen Ring, der nicht geschlossen ist: Er braucht mindestens {least} Punkte, und der letzte muss der erste sein (RFC 7946)",
  "plan-floor-unreadable":
    "Das Geschoss des Objekts {feature} des Plans ist nicht lesbar: {error}",
  "plan-geometry-unfit":
    "Das Objekt {feature} des Plans hat die Geometrie {shape}: Sie muss eine von diesen sein: {shapes}",
  "plan-points-too-few":
    "Das Objekt {feature} des Plans hat weniger als zwei Punkte [east_m, north_m]",
  "plan-pictures-unreadable":
    "Der Plan hat Bilder, die nicht lesbar sind: {error}",
  "plan-pictures-of-one-floor":
    "Der Plan hat mehr als ein Bild von Geschoss {floor}",
  "plan-pictures-too-large":
    "Die Bilder des Plans haben zusammen mehr als {most_mb}; senden Sie kleinere oder weniger Geschosse",
  "plan-picture-no-webp":
    "Das Bild des Plans von Geschoss {floor} ist kein WebP in base64",
};
