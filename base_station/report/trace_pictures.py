"""Pictures of the data about an alarm: a strip for motion, air, height and link."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from base_station.report import texts
from base_station.report.contents import AlarmTrace, Series
from base_station.report.markup import Markup, element
from base_station.report.style import LIMIT, MIDDLE, RAISED, RIGHT, SMALL, STRIP, VALUE
from shared.clock import NS_PER_S

_WIDTH, _LEFT, _RIGHT = 340.0, 62.0, 8.0
_INNER = _WIDTH - _LEFT - _RIGHT
_STRIP, _APART = 30.0, 6.0
_ABOUT_S = 60.0
_LONGEST_STEP_S = 5.0  # values further apart are not joined by a line
_LEAST_SPAN = 1.0  # of values that are drawn

# The thresholds of which rules are drawn in which strip.
_IN_MOTION = {"no-motion": ("pre_alert_s", "alarm_s")}
_IN_TEMPERATURE = {"heat": ("caution_degc", "warning_degc", "critical_degc")}


def trace_picture(trace: AlarmTrace) -> Markup:
    thresholds = dict(trace.thresholds)
    strips: tuple[tuple[str, Series, Mapping[str, Sequence[str]]], ...] = (
        (texts.MOTIONLESS, trace.motionless_s, _IN_MOTION),
        (texts.TEMPERATURE, trace.temperature_degc, _IN_TEMPERATURE),
        (texts.HEIGHT, trace.height_m, {}),
    )
    drawn, top = [], 4.0
    for name, series, rules in strips:
        limits = [thresholds[one] for one in rules.get(trace.rule, ()) if one in thresholds]
        drawn.append(_strip(top, name, trace.raised_ns, series, limits))
        top += _STRIP + _APART
    drawn.append(_link(top, trace))
    top += 12.0
    middle, raised = _x(0.0), texts.clock_time(trace.raised_ns)
    height = top + 16.0
    drawn += [
        element("path", d=f"M{middle:.1f} 2V{top:.1f}", **RAISED),
        *(
            element("text", f"{at_s:+.0f} s", x=_x(at_s), y=top + 11.0, **MIDDLE)
            for at_s in (-50.0, 50.0)
        ),
        element("text", raised, x=middle, y=top + 11.0, **MIDDLE),
    ]
    return element(
        "svg",
        drawn,
        viewBox=f"0 0 {_WIDTH:.0f} {height:.0f}",
        width=f"{_WIDTH:.0f}",
        height=f"{height:.0f}",
        role="img",
        aria_label=trace.text,
    )


def _strip(
    top: float, name: str, raised_ns: int, series: Series, thresholds: Sequence[float]
) -> Markup:
    values = [value for _, value in series]
    shown = [one for one in thresholds if values and one <= 1.5 * max(*values, _LEAST_SPAN)]
    low, high = min([*values, *shown], default=0.0), max([*values, *shown], default=0.0)
    if high - low < _LEAST_SPAN:
        low, high = (low + high - _LEAST_SPAN) / 2, (low + high + _LEAST_SPAN) / 2

    def y_of(value: float) -> float:
        return top + _STRIP - 3.0 - (value - low) / (high - low) * (_STRIP - 6.0)

    content = [
        element("rect", x=_LEFT, y=top, width=_INNER, height=_STRIP, **STRIP),
        element("text", name, x=2.0, y=top + _STRIP / 2, **SMALL),
    ]
    if not series:
        content.append(
            element("text", texts.UNKNOWN, x=_LEFT + 6.0, y=top + _STRIP / 2 + 4.0, **SMALL)
        )
        return element("g", content)
    content += [
        element("text", f"{value:z.0f}", x=_LEFT - 4.0, y=y_of(value) + 3.0, **RIGHT)
        for value in (max(values), min(values))
        if value == max(values) or y_of(min(values)) - y_of(max(values)) > 9.0
    ]
    content += [
        element("path", d=f"M{_LEFT:.1f} {y_of(one):.1f}H{_WIDTH - _RIGHT:.1f}", **LIMIT)
        for one in shown
    ]
    content.append(element("path", d=_path(series, raised_ns, y_of), **VALUE))
    return element("g", content)


def _path(series: Series, raised_ns: int, y_of: Callable[[float], float]) -> str:
    parts, before_s = [], -2.0 * _ABOUT_S
    for t_ns, value in series:
        at_s = (t_ns - raised_ns) / NS_PER_S
        verb = "M" if at_s - before_s > _LONGEST_STEP_S else "L"
        parts.append(f"{verb}{_x(at_s):.1f} {y_of(value):.1f}")
        before_s = at_s
    return "".join(parts)


def _link(top: float, trace: AlarmTrace) -> Markup:
    marks = "".join(
        f"M{_x((t_ns - trace.raised_ns) / NS_PER_S):.1f} {top:.1f}v8" for t_ns in trace.received_ns
    )
    return element(
        "g",
        element("text", texts.LINK, x=2.0, y=top + 8.0, **SMALL),
        element("path", d=marks, **VALUE),
    )


def _x(at_s: float) -> float:
    return _LEFT + (at_s + _ABOUT_S) / (2.0 * _ABOUT_S) * _INNER
