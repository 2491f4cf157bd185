"""Picture of a sweep over a threshold: alarms per hour of wear, and the outcome of the alarms that
were raised at the time, for each value.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from base_station.replay.rehearsal.report import LevelFigures, RehearsalReport
from base_station.report.markup import Markup, element, joined
from base_station.report.style import LIMIT, MIDDLE, NUMBER, RIGHT, SMALL, STRIP, VALUE

_WIDTH, _LEFT, _RIGHT = 520.0, 70.0, 12.0
_INNER = _WIDTH - _LEFT - _RIGHT
_STRIP, _APART, _TITLE = 80.0, 32.0, 34.0
_DASHED = {**VALUE, "stroke_dasharray": "5 4"}

_Line = tuple[str, dict[str, str | float], Callable[[LevelFigures], float | None]]
_STRIPS: tuple[tuple[str, tuple[_Line, ...]], ...] = (
    (
        "alarms per hour of wear",
        (("rehearsed", VALUE, lambda one: one.rehearsed_per_hour),),
    ),
    (
        "alarms against then",
        (
            ("missed", VALUE, lambda one: float(one.missed)),
            ("added", _DASHED, lambda one: float(one.added)),
        ),
    ),
    ("median shift in s", (("alarms found by both", VALUE, lambda one: one.median_shift_s),)),
)


def trade_off_picture(report: RehearsalReport) -> Markup:
    """Self-contained SVG: for each level of each rule one strip for each figure, over the swept
    threshold.  Dotted: the value at the time.
    """
    points = [point for point in report.points if not point.problem]
    values = [point.thresholds[report.swept] for point in points]
    levels = [(one.rule, one.level) for one in (points[0].levels if points else ())]
    drawn, top = [], 0.0
    for row, (rule, level) in enumerate(levels):
        figures = [point.levels[row] for point in points]
        heading = f"{rule}: {level}, over {report.swept}"
        drawn.append(element("text", heading, x=4.0, y=top + 14.0, **NUMBER))
        top += _TITLE
        for name, lines in _STRIPS:
            drawn.append(_strip(top, name, values, figures, lines))
            top += _STRIP + _APART
    height = max(top, 1.0)
    return element(
        "svg",
        element("rect", x=0, y=0, width=_WIDTH, height=height, fill="#fff"),
        drawn,
        xmlns="http://www.w3.org/2000/svg",
        viewBox=f"0 0 {_WIDTH:.0f} {height:.0f}",
        width=f"{_WIDTH:.0f}",
        height=f"{height:.0f}",
    )


def _strip(
    top: float,
    name: str,
    values: Sequence[float],
    figures: Sequence[LevelFigures],
    lines: Sequence[_Line],
) -> Markup:
    then = figures[0].recorded_per_hour if name == _STRIPS[0][0] else None
    known = [one for _, _, get in lines for one in map(get, figures) if one is not None]
    low, high = min([0.0, *known, *_given(then)]), max([0.0, *known, *_given(then)])
    high = high if high > low else low + 1.0

    def x_of(value: float) -> float:
        return _LEFT + (value - values[0]) / max(values[-1] - values[0], 1e-9) * _INNER

    def y_of(value: float) -> float:
        return top + _STRIP - 4.0 - (value - low) / (high - low) * (_STRIP - 8.0)

    legend = ", ".join(
        f"{text} (dashed)" if style is _DASHED else text for text, style, _ in lines
    ) + ("; dotted: then" if then is not None else "")
    content = [
        element("rect", x=_LEFT, y=top, width=_INNER, height=_STRIP, **STRIP),
        element("text", f"{name}: {legend}", x=_LEFT, y=top - 4.0, **SMALL),
        *(
            element("text", f"{one:.3g}", x=_LEFT - 4.0, y=y_of(one) + 3.0, **RIGHT)
            for one in (low, high)
        ),
        *(
            element("text", f"{one:g}", x=x_of(one), y=top + _STRIP + 11.0, **MIDDLE)
            for one in _marked(values)
        ),
    ]
    if then is not None:
        content.append(element("path", d=f"M{_LEFT:.1f} {y_of(then):.1f}h{_INNER:.1f}", **LIMIT))
    for _, style, get in lines:
        placed = [
            f"{x_of(value):.1f} {y_of(figure):.1f}"
            for value, one in zip(values, figures, strict=True)
            if (figure := get(one)) is not None
        ]
        if placed:
            content.append(element("path", d="M" + "L".join(placed), **style))
            content += [
                element("circle", cx=place.split()[0], cy=place.split()[1], r=1.8)
                for place in placed
            ]
    return element("g", joined(content))


def _given(value: float | None) -> tuple[float, ...]:
    return () if value is None else (value,)


def _marked(values: Sequence[float]) -> Sequence[float]:
    """At most ten of the values, both ends among them."""
    every = -(-len(values) // 10)
    return sorted({*values[::every], values[-1]}) if values else ()
