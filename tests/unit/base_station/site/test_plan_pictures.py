"""Pictures in a plan: pictures that a console could not draw are refused."""

from __future__ import annotations

import base64
from typing import Any

import msgspec
import pytest

from base_station.site.plan import check_plan
from base_station.site.plan_pictures import MOST_BASE64
from shared.errors import UserError

_WEBP = base64.b64encode(b"RIFF\x00\x00\x00\x00WEBPVP8 ").decode()


def picture(**changed: Any) -> dict[str, Any]:
    corners = {"upper_left_m": [0, 20], "upper_right_m": [30, 20], "lower_left_m": [0, 0]}
    return {"floor": 0, "webp": _WEBP, **corners, **changed}


def plan(pictures: Any) -> bytes:
    muster = {"frame": "site-m", "pictures": pictures}
    return msgspec.json.encode({"type": "FeatureCollection", "muster": muster, "features": []})


def test_one_picture_a_floor_is_accepted() -> None:
    assert check_plan(plan([picture(), picture(floor=1)])).damage == ""


@pytest.mark.parametrize(
    ("pictures", "reason"),
    [
        ("none", "cannot be read"),
        ([{"floor": 0}], "cannot be read"),
        ([picture(upper_left_m=[0, 1e9])], "cannot be read"),
        ([picture(), picture()], "more than one picture of floor 0"),
        ([picture(webp="<script>")], "no WebP"),
        ([picture(webp=base64.b64encode(b"GIF89a").decode())], "no WebP"),
        ([picture(floor=n, webp="A" * (MOST_BASE64 // 2 + 4)) for n in (0, 1)], "MB together"),
    ],
)
def test_pictures_that_cannot_be_drawn_are_refused(pictures: Any, reason: str) -> None:
    with pytest.raises(UserError, match=reason):
        check_plan(plan(pictures))
