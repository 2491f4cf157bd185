"""Layout for Foxglove: all units on the map, all alarms, heights and temperatures."""

from __future__ import annotations

from collections.abc import Iterable

from foxglove.layouts import (
    Layout,
    LogConfig,
    LogPanel,
    MapConfig,
    MapPanel,
    PlotConfig,
    PlotPanel,
    PlotSeries,
    SplitContainer,
    SplitItem,
)

from base_station.foxglove.server import EVERY_ALARM
from shared.channels import FUSED, TEMPERATURE
from shared.messages import STATION_ID

_ZOOM_OF_BUILDING = 18


def make_layout(unit_ids: Iterable[str]) -> str:
    """Return the JSON that Foxglove imports (*Layouts*, *Import from file*)."""
    units = sorted(unit_ids)
    fused = FUSED.key(STATION_ID)
    heights = [
        PlotSeries(
            value=f'"{fused}"{{unit_id=="{unit}"}}.down_mm.@div(-1000)', label=f"{unit} height, m"
        )
        for unit in units
    ]
    temperatures = [
        PlotSeries(value=f'"{TEMPERATURE.key(unit)}".ambient_cdegc.@div(100)', label=f"{unit}, °C")
        for unit in units
    ]
    side = SplitContainer(
        direction="column",
        items=[
            SplitItem(
                proportion=1, content=LogPanel(config=LogConfig(topic_to_render=EVERY_ALARM))
            ),
            SplitItem(proportion=1, content=PlotPanel(config=PlotConfig(paths=temperatures))),
            SplitItem(proportion=1, content=PlotPanel(config=PlotConfig(paths=heights))),
        ],
    )
    content = SplitContainer(
        direction="row",
        items=[
            SplitItem(proportion=2, content=MapPanel(config=MapConfig(zoom_level=18))),
            SplitItem(proportion=1, content=side),
        ],
    )
    return Layout(content=content).to_json()
