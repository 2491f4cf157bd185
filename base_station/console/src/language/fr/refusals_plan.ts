/** Refusals about plans, drawings and maps, by their codes, in French. */
import type { Part } from "../catalogue";

export const refusal_plan: Part<"refusal_plan"> = {
  "base-map-none":
    "Il n’y a pas de carte de base.",
  "base-map-unknown":
    "Cette carte de base n’existe pas.",
  "drawing-no-wall":
    "Le dessin n’a aucune ligne qui pourrait être un mur",
  "drawing-too-fine":
    "Le dessin a plus de {most} points\u00a0; laissez de côté meubles et hachures",
  "drawing-took-too-long":
    "La lecture du dessin a pris trop de temps\u00a0; envoyez-en une partie",
  "drawing-unknown":
    "Ce fichier n’est pas un dessin lisible\u00a0; envoyez {kinds}",
  "drawing-unreadable":
    "Le dessin est illisible\u00a0; enregistrez-le de nouveau, ou en PNG, et envoyez cela",
  "dxf-library-missing":
    "La bibliothèque ezdxf, qui lit le DXF, n’est pas installée à la station\u00a0: pip install --require-hashes -r deploy/requirements-plans.lock\u00a0; ou imprimez le dessin en PDF",
  "dxf-no-unit":
    "Le DXF ne dit pas dans quelle unité de longueur il est dessiné\u00a0; choisissez-la, et envoyez-le encore",
  "dxf-no-wall":
    "Le dessin n’a aucune ligne qui pourrait être un mur",
  "dxf-too-fine":
    "Le DXF a plus de {most} points\u00a0; laissez de côté meubles et hachures",
  "dxf-unreadable":
    "Le DXF est illisible\u00a0; enregistrez-le de nouveau, ou imprimez-le en PDF",
  "geojson-empty":
    "Ce GeoJSON n’a ni ligne ni surface",
  "geojson-no-collection":
    "{file} n’est pas une FeatureCollection GeoJSON",
  "geojson-no-json":
    "{file} n’est pas du JSON\u00a0: {error}",
  "geojson-no-numbers":
    "Ce GeoJSON a des coordonnées qui ne sont pas des nombres",
  "geojson-not-degrees":
    "Les coordonnées de ce GeoJSON ne sont pas des degrés de longitude et de latitude\u00a0; enregistrez-le en EPSG:4326",
  "ifc-contradictory":
    "L’IFC a des références que son schéma ne permet pas\u00a0; vérifiez-le et enregistrez-le de nouveau, ou imprimez ses étages en PDF",
  "ifc-library-missing":
    "La bibliothèque ifcopenshell, qui lit l’IFC, n’est pas installée à la station\u00a0: pip install --require-hashes -r deploy/requirements-ifc.lock\u00a0; ou exportez les étages en DXF, IMDF ou PDF",
  "ifc-no-storey":
    "L’IFC n’a pas d’étages (IfcBuildingStorey)\u00a0: exportez-le avec eux, ou imprimez ses étages en PDF",
  "ifc-no-wall":
    "L’IFC n’a de mur avec une forme sur aucun de ses étages\u00a0; imprimez ses étages en PDF",
  "ifc-too-detailed":
    "L’IFC a trop de détails\u00a0; exportez seulement murs, portes et escaliers",
  "ifc-torn":
    "L’IFC est tronqué\u00a0: sa fin manque\u00a0; copiez-le ou enregistrez-le de nouveau",
  "ifc-unreadable":
    "L’IFC est illisible\u00a0; enregistrez-le de nouveau en IFC2x3, IFC4 ou IFC4x3, ou imprimez ses étages en PDF",
  "imdf-too-large":
    "Cet IMDF dépasse 60 Mo\u00a0; envoyez-en un bâtiment",
  "map-too-many-bytes":
    "La carte dépasse {most_mb}",
  "map-unreadable":
    "La carte est illisible\u00a0; envoyez un fichier JPEG, PNG ou WebP",
  "pdf-encrypted":
    "Le PDF est chiffré\u00a0; enregistrez-le sans mot de passe, et envoyez cela",
  "pdf-library-missing":
    "La bibliothèque pypdfium2, qui lit le PDF, n’est pas installée à la station\u00a0: pip install --require-hashes -r deploy/requirements-plans.lock\u00a0; ou enregistrez la page en PNG",
  "pdf-no-page":
    "Le PDF n’a pas de page {page}\u00a0: il en a {pages}",
  "pdf-unreadable":
    "Le PDF est illisible\u00a0; enregistrez la page en PNG, et envoyez cela",
  "picture-is-line":
    "L’image n’a pas plus d’une ligne de pixels",
  "picture-too-detailed":
    "L’image a trop de détails pour un plan\u00a0; envoyez-en une avec moins de couleurs",
  "picture-unreadable":
    "L’image est illisible\u00a0; enregistrez-la en PNG, JPEG ou WebP",
  "plan-floor-twice":
    "Le plan nomme l’étage {floor} plus d’une fois",
  "plan-floor-without-height":
    "Le plan a des murs ou des escaliers à l’étage {floor}, dont la hauteur manque\u00a0: «\u00a0floors\u00a0» sous «\u00a0muster\u00a0» doit le nommer avec «\u00a0down_m\u00a0»",
  "plan-floors-unreadable":
    "La liste des étages du plan est illisible\u00a0: {error}",
  "plan-name":
    "Le nom du plan doit être un texte\u00a0: «\u00a0name\u00a0» sous «\u00a0muster\u00a0»",
  "plan-no-collection":
    "Le plan n’est pas une FeatureCollection GeoJSON\u00a0: {error}",
  "plan-no-json":
    "Le plan n’est pas du JSON\u00a0: {error}",
  "plan-no-scale":
    "Le plan n’a pas d’échelle\u00a0: «\u00a0frame\u00a0» sous «\u00a0muster\u00a0» doit être «\u00a0site-m\u00a0», et les coordonnées doivent être [east_m, north_m] en mètres",
  "plan-none":
    "Il n’y a pas de plan.",
  "plan-not-geojson":
    "Le plan n’est pas une FeatureCollection GeoJSON",
  "plan-outlines-too-fine":
    "Les contours du plan ont {points} points\u00a0: plus de {most} sont trop pour les examiner à chaque position\u00a0; dessinez-les avec moins",
  "plan-stairs-too-many":
    "Le plan a {stairs} escaliers\u00a0: plus de {most}",
  "world-file-grid":
    "{grid} n’est aucune des grilles d’un fichier world\u00a0: {known}",
  "world-file-makes-line":
    "Le fichier world fait de l’image une ligne",
  "world-file-off-earth":
    "En {grid}, les nombres du fichier world ne sont nulle part sur la Terre",
  "world-file-unfit":
    "Un fichier world a six nombres, un par ligne",
  "zip-no-imdf":
    "Ce fichier ZIP n’est pas de l’IMDF\u00a0: il n’a pas de level.geojson",
  "zip-unreadable":
    "Ce fichier ZIP est illisible\u00a0: {error}",
  "plan-not-sent-as-json":
    "Envoyez un objet JSON comme contenu, avec l’en-tête Content-Type: application/json",
  "ifc-zip-too-large":
    "L’IFC de ce fichier ZIP dépasse {most_mb}\u00a0; exportez seulement murs, portes, escaliers et locaux",
  "ifc-zip-unreadable":
    "Ce fichier ZIP est illisible\u00a0: {error}",
  "picture-too-large":
    "L’image a plus de {most_million} millions de pixels\u00a0; réduisez-la",
  "drawing-size-unfit":
    "Le dessin a une largeur de {wide_m}\u00a0: choisissez une autre unité de longueur, ou envoyez un seul bâtiment",
  "map-size-unfit":
    "L’image mesurerait {wide_m} sur {high_m}\u00a0; de {smallest_m} à {largest_m} sont plausibles",
  "plan-walls-too-long":
    "Les murs du plan ont une longueur de {walls_m}\u00a0: aucun bâtiment n’en a plus de {most_m}",
  "plan-feature-unreadable":
    "L’objet {feature} du plan est illisible\u00a0: {error}",
  "plan-ring-open":
    "L’objet {feature} du plan a un anneau qui n’est pas fermé\u00a0: il lui faut au moins {least} points, et le dernier doit être le premier (RFC 7946)",
  "plan-floor-unreadable":
    "L’étage de l’objet {feature} du plan est illisible\u00a0: {error}",
  "plan-geometry-unfit":
    "L’objet {feature} du plan a la géométrie {shape}\u00a0: elle doit être l’une de {shapes}",
  "plan-points-too-few":
    "L’objet {feature} du plan a moins de deux points [east_m, north_m]",
  "plan-pictures-unreadable":
    "Le plan a des images illisibles\u00a0: {error}",
  "plan-pictures-of-one-floor":
    "Le plan a plus d’une image de l’étage {floor}",
  "plan-pictures-too-large":
    "Les images du plan dépassent ensemble {most_mb}\u00a0; envoyez-en de plus petites, ou moins d’étages",
  "plan-picture-no-webp":
    "L’image du plan de l’étage {floor} n’est pas du WebP en base64",
};
