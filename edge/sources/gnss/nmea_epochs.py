"""Epochs of NMEA sentences: those of one instant put together, for a receiver sends each fix in
several.

Which comes last differs from receiver to receiver, and is learnt: what stood last before the time
changed, or before a pause, ends the next instant at once.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from edge.samples import GpsSample
from edge.sources.gnss.accuracy import (
    UERE_CARRIER_M,
    UERE_CORRECTED_M,
    UERE_SINGLE_M,
    first_known,
    from_axes,
    from_dop,
    from_hdop,
)
from edge.sources.gnss.interface import MOST_SATELLITES, Report
from edge.sources.gnss.nmea_sentences import Sentence
from shared.clock import NS_PER_S

_KNOT_MPS = 1852.0 / 3600.0
_OF_AN_INSTANT = ("GGA", "GNS", "RMC", "GST")  # one of each; they say which
_WITH_PLACE = ("GGA", "GNS", "RMC")
_GSA_HOLDS_NS = 3 * NS_PER_S
_NO_FIX = frozenset({6.0, 7.0, 8.0})  # GGA: estimated, typed in, simulated
_UERE_M = {2: UERE_CORRECTED_M, 4: UERE_CARRIER_M, 5: UERE_CARRIER_M}  # by GGA's quality
_NO_FIX_MODES = frozenset("NEMS")  # RMC and GNS, a letter a constellation: the same
_UERE_M_OF_MODE = {"D": UERE_CORRECTED_M, "R": UERE_CARRIER_M, "F": UERE_CARRIER_M}
_NOTHING = Sentence("", {})


@dataclass(slots=True)
class _Instant:
    """Sentences of one instant."""

    began_ns: int | None = None  # when the first of its sentences came
    of_day_ns: int | None = None
    sentences: dict[str, Sentence] = field(default_factory=dict)
    last_kind: str = ""
    is_reported: bool = False

    def accepts(self, sentence: Sentence) -> bool:
        if sentence.kind not in _OF_AN_INSTANT:
            return True
        if sentence.kind in self.sentences:
            return False
        at_ns = sentence.of_day_ns
        return at_ns is None or self.of_day_ns is None or at_ns == self.of_day_ns

    def take(self, sentence: Sentence, began_ns: int) -> None:
        self.last_kind = sentence.kind
        if sentence.kind in _OF_AN_INSTANT:
            self.sentences[sentence.kind] = sentence
            self.began_ns = began_ns if self.began_ns is None else self.began_ns
            self.of_day_ns = sentence.of_day_ns if self.of_day_ns is None else self.of_day_ns

    @property
    def has_place(self) -> bool:
        return any(kind in self.sentences for kind in _WITH_PLACE)


class Epochs:
    """Assembler; ``push`` sentences as they come; each instant is given once, when it is
    complete.
    """

    def __init__(self) -> None:
        self._instant: _Instant | None = None
        self._last_kind = ""  # the kind that stood last
        self._gsa = _NOTHING
        self._gsa_ns = 0

    def push(self, sentence: Sentence, began_ns: int) -> tuple[Report, ...]:
        reports: tuple[Report, ...] = ()
        if self._instant is not None and not self._instant.accepts(sentence):
            reports = self.end_of_burst()
        if self._instant is None:
            self._instant = _Instant()
        self._instant.take(sentence, began_ns)
        if sentence.kind == "GSA":
            self._gsa, self._gsa_ns = sentence, began_ns
        if sentence.kind == self._last_kind:
            reports += self._report()
        return reports

    def end_of_burst(self) -> tuple[Report, ...]:
        """End the instant: nothing comes any more, or a sentence of another one."""
        reports = self._report()
        if self._instant is not None and self._instant.has_place:
            self._last_kind = self._instant.last_kind
        self._instant = None
        return reports

    def _report(self) -> tuple[Report, ...]:
        instant = self._instant
        if (
            instant is None
            or instant.began_ns is None
            or not instant.has_place
            or instant.is_reported
        ):
            return ()
        instant.is_reported = True
        is_fresh = abs(instant.began_ns - self._gsa_ns) < _GSA_HOLDS_NS
        fix = _fix(instant.began_ns, instant.sentences, self._gsa if is_fresh else _NOTHING)
        return (Report(fix, instant.of_day_ns if fix.fix_type else None),)


def _fix(t_ns: int, sentences: dict[str, Sentence], gsa: Sentence) -> GpsSample:
    rmc, gst = sentences.get("RMC", _NOTHING), sentences.get("GST", _NOTHING)
    main = sentences.get("GGA") or sentences.get("GNS") or rmc
    lat_deg, lon_deg = main.place
    # Above the sea and the sea above the ellipsoid: without both there is no height.
    height_m = main.number("alt") + main.number("sep")
    fix_type = _fix_type(sentences, gsa)
    if not math.isfinite(lat_deg):
        fix_type = 0
    if fix_type == 3 and not math.isfinite(height_m):
        fix_type = 2
    if fix_type == 0:
        lat_deg = lon_deg = math.nan
    uere_m, satellites = _uere_m(sentences), first_known(main.number("numSV"))
    hdop = first_known(main.number("HDOP"), gsa.number("HDOP"))
    axes_m = from_axes(gst.number("stdLat"), gst.number("stdLong"))
    ellipse_m = from_axes(gst.number("stdMajor"), gst.number("stdMinor"))
    vdop_std_m = from_dop(gsa.number("VDOP"), uere_m)
    return GpsSample(
        t_ns=t_ns,
        lat_deg=lat_deg,
        lon_deg=lon_deg,
        height_m=height_m if fix_type == 3 else math.nan,
        horizontal_std_m=first_known(axes_m, ellipse_m, from_hdop(hdop, uere_m)),
        vertical_std_m=first_known(gst.number("stdAlt"), vdop_std_m),
        fix_type=fix_type,
        satellites=0 if math.isnan(satellites) else int(min(satellites, MOST_SATELLITES)),
        speed_mps=rmc.number("spd") * _KNOT_MPS,
        course_rad=math.radians(rmc.number("cog") % 360.0),
    )


def _fix_type(sentences: dict[str, Sentence], gsa: Sentence) -> int:
    """Return 0, 2 or 3; one sentence that reports no fix is enough."""
    gga, gns, rmc = (sentences.get(kind) for kind in _WITH_PLACE)
    nones = (
        gga is not None and not gga.number("quality") > 0.0,
        gga is not None and gga.number("quality") in _NO_FIX,
        gns is not None and set(gns.text("posMode")) <= _NO_FIX_MODES,
        rmc is not None and (rmc.text("status") != "A" or rmc.text("posMode") in _NO_FIX_MODES),
        gsa.number("navMode") == 1.0,
    )
    if any(nones):
        return 0
    return 2 if gsa.number("navMode") == 2.0 else 3


def _uere_m(sentences: dict[str, Sentence]) -> float:
    if "GGA" in sentences:
        quality = sentences["GGA"].number("quality")
        return _UERE_M.get(int(quality), UERE_SINGLE_M) if math.isfinite(quality) else UERE_SINGLE_M
    modes = (
        set(sentences.get("GNS", sentences.get("RMC", _NOTHING)).text("posMode")) - _NO_FIX_MODES
    )
    return max((_UERE_M_OF_MODE.get(mode, UERE_SINGLE_M) for mode in modes), default=UERE_SINGLE_M)
