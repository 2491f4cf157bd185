"""The layout names topics that exist in the log."""

from __future__ import annotations

import json
import re

from base_station.foxglove.layout import make_layout
from shared.mcap_log import wire_type_of

SERIES = re.compile(r'"(?P<topic>[^"]+)"(\{[^}]*\})?\.(?P<field>\w+)\.@div\(-?\d+\)')


def test_every_series_reads_a_field_of_the_log() -> None:
    layout = json.loads(make_layout(["FF-02", "FF-01"]))
    beside_map = layout["content"]["items"][1]["content"]["items"]
    plots = [item["content"] for item in beside_map if item["content"]["panelType"] == "Plot"]
    series = [path["value"] for plot in plots for path in plot["config"]["paths"]]
    assert len(series) == 4
    for value in series:
        parts = SERIES.fullmatch(value)
        assert parts is not None
        wire_type = wire_type_of(parts["topic"])
        assert wire_type is not None
        assert parts["field"] in wire_type.DESCRIPTOR.fields_by_name


def test_units_are_in_the_order_of_their_names() -> None:
    assert make_layout(["b", "a"]) == make_layout(["a", "b"])
