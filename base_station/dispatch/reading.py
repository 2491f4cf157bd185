"""Reading of a report of the dispatch centre, in any of the formats."""

from __future__ import annotations

import re

import msgspec

from base_station.dispatch.config import DispatchConfig
from base_station.dispatch.eido import is_eido, read_eido
from base_station.dispatch.plain_report import read_plain
from base_station.dispatch.report_parts import ReportParts
from shared.coded_text import coded
from shared.errors import WireError
from shared.messages.station import NoteDispatch

_CAMEL_CASE = re.compile(r"(?<=[a-z])(?=[A-Z])|_")


def read_report(body: bytes, config: DispatchConfig, now_ns: int) -> NoteDispatch:
    """Read a report as it will be logged, with its type in words.  A report without a time of
    change is taken for changed now (``now_ns``: station time, UTC).

    Raises WireError with a sentence if it is no JSON object or has no number.
    """
    try:
        content = msgspec.json.decode(body)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise WireError(
            coded(
                "report-json-unreadable",
                "The body is no JSON that can be read: {error}.",
                error=str(error),
            )
        ) from error
    if not isinstance(content, dict):
        raise WireError(
            coded(
                "report-no-object",
                "The body is no JSON object: send an EIDO, or an object with a number.",
            )
        )
    parts = ReportParts(now_ns)
    report = read_eido(content, parts) if is_eido(content) else read_plain(content, parts)
    return msgspec.structs.replace(
        report,
        type=type_in_words(report, config),
        updated_ns=report.updated_ns or now_ns,
        warnings=parts.warnings,
        warning_codes=parts.warning_codes,
    )


def type_in_words(report: NoteDispatch, config: DispatchConfig) -> str:
    """Type of a dispatch in words: from the settings, otherwise from the report, otherwise its
    code, split into words.
    """
    words = config.types.get(report.type_code) or report.type
    return words or _CAMEL_CASE.sub(" ", report.type_code).capitalize()
