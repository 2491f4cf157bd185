"""Key expressions of the project mean the same as Zenoh's."""

from __future__ import annotations

import zenoh
from hypothesis import given
from hypothesis import strategies as st

from shared.bus_handlers import intersects

chunks = st.sampled_from(["a", "b", "muster", "*", "**"])
expressions = st.lists(chunks, min_size=1, max_size=5).map("/".join)


@given(expressions, expressions)
def test_intersection_is_as_in_zenoh(first: str, second: str) -> None:
    expected = zenoh.KeyExpr.autocanonize(first).intersects(zenoh.KeyExpr.autocanonize(second))
    assert intersects(first, second) is expected
