"""Kinds of forwarders.  A new kind is a file or folder, a line here and a table of
settings in ``StationConfig``.
"""

from __future__ import annotations

from base_station.forwarders.department.forwarder import DepartmentForwarder
from base_station.forwarders.interface import ForwarderKind
from base_station.forwarders.tak.forwarder import TakForwarder

FORWARDERS: tuple[ForwarderKind, ...] = (
    ForwarderKind("tak", TakForwarder),
    ForwarderKind("department", DepartmentForwarder),
)
