"""Descriptions of fields about plans, drawings and their place on the Earth."""

from __future__ import annotations

from collections.abc import Mapping

FIELDS: Mapping[str, str] = {
    # ---- drawings
    "webp": "The picture as WebP, in base64.",
    "width_px": "The picture's width in pixels.",
    "height_px": "The picture's height in pixels.",
    "PlanDraft.picture": "A picture of a floor without scale; null: the file is a plan.",
    "PlanDraft.plan": "The plan as the station takes it (GeoJSON in site metres); null: the file "
    "is a picture.",
    "PlanDraft.lat_deg": "Latitude (WGS-84) of the plan's origin; null: the file does not say it.",
    "PlanDraft.lon_deg": "Longitude (WGS-84) of the plan's origin; null: the file does not say it.",
    "is_place_surveyed": "False: the place of the plan's origin is a suggestion, such as a city "
    "that a drawing program sets by itself; a person has to look at it.",
    "pages": "How many pages the file has.",
    "page": "The page of a PDF, from 1.",
    "unit": "Unit of length of a DXF; left out: as the file says.",
    "notes": "What of the file is not in the draft, for a person.",
    "PlanDraft.note_codes": "Codes of the notes, in their order.",
    "TextCodeAnswer.code": "Code of the sentence.",
    "TextCodeAnswer.texts": "Texts in the sentence, by name.",
    "TextCodeAnswer.numbers": "Numbers in the sentence, by name; units are in the names.",
    # ---- georeference
    "lat_deg": "Latitude of the incident frame's origin (WGS-84), degrees.",
    "lon_deg": "Longitude of the incident frame's origin (WGS-84), degrees.",
    "height_m": "Height of the incident frame's origin, metres.",
    "plan_rotation_rad": "True heading of the plan's north, radians clockwise.",
    "image_url": "Where the picture is fetched.",
    "upper_left": "Latitude and longitude of the picture's upper left corner, degrees.",
    "upper_right": "Latitude and longitude of the picture's upper right corner, degrees.",
    "lower_left": "Latitude and longitude of the picture's lower left corner, degrees.",
}
