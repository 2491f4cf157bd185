"""Elements of an XML file of tracks, one at a time: the file is never in memory as a whole."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple
from xml.etree.ElementTree import Element, ParseError

from defusedxml import DefusedXmlException
from defusedxml.ElementTree import iterparse

from base_station.storage.imports import ImportedPoint
from shared.clock import NS_PER_S
from shared.coded_text import coded
from shared.errors import UserError

_DEEPEST = 100  # elements in each other; folders of KML are a few


class XmlElement(NamedTuple):
    """Element that has ended, without its namespace and its children."""

    name: str
    parent: str  # empty: it is the outermost
    text: str
    attributes: Mapping[str, str]


def elements_of(path: Path, damage: list[str]) -> Iterator[XmlElement]:
    """Elements before the first fault of the file, which is described in ``damage``. Raises
    UserError if the file has entities.
    """
    parents: list[Element] = []
    try:
        for event, element in iterparse(path, ("start", "end"), forbid_dtd=True):
            if event == "start":
                parents.append(element)
                if len(parents) > _DEEPEST:
                    raise UserError(
                        coded(
                            "import-too-deep",
                            "it is no file of tracks: its elements lie {deepest} deep",
                            deepest=_DEEPEST,
                        )
                    )
                continue
            parents.pop()
            parent = parents[-1] if parents else None
            yield XmlElement(
                local_name(element),
                "" if parent is None else local_name(parent),
                (element.text or "").strip(),
                element.attrib,
            )
            if parent is not None:
                parent.remove(element)
    except DefusedXmlException as error:
        raise UserError(
            coded(
                "import-has-entities",
                "it has entities or a document type, which no track needs and which can fill the "
                "memory: it is not read",
            )
        ) from error
    except (ParseError, ValueError) as error:
        damage.append(
            coded(
                "import-breaks-off",
                "it cannot be read to its end ({error}): what stands behind is lost",
                error=str(error),
            )
        )


def local_name(element: Element) -> str:
    return str(element.tag).rpartition("}")[2]


def is_xml_of(head: bytes, root: str) -> bool:
    """True if the first bytes of a file begin that element, in UTF-8 or UTF-16."""
    encoding = "utf-16" if head.startswith((b"\xff\xfe", b"\xfe\xff")) else "utf-8"
    text = head.decode(encoding, "ignore")
    is_xml = text.lstrip("\ufeff \t\r\n").startswith("<")
    return is_xml and (f"<{root}" in text or f":{root}" in text)


def point_of(time: str, lat: str, lon: str, height: str) -> ImportedPoint | None:
    """Return a point; None where time, latitude or longitude is missing or not valid.  A height is
    optional.
    """
    try:
        t_ns = _utc_ns(time)
        lat_deg, lon_deg = float(lat), float(lon)
        height_m = float(height) if height else math.nan
    except (ValueError, OverflowError):
        return None
    if not (abs(lat_deg) <= 90.0 and abs(lon_deg) <= 180.0):  # no number is neither
        return None
    return ImportedPoint(t_ns, lat_deg, lon_deg, height_m if math.isfinite(height_m) else None)


def _utc_ns(text: str) -> int:
    """UTC of a time.  ValueError if it is no time of XML Schema with its zone."""
    at = datetime.fromisoformat(text)
    if at.tzinfo is None:
        raise ValueError("no zone")
    return round(at.astimezone(UTC).timestamp() * 1000) * (NS_PER_S // 1000)
