"""Configuration files: settings that are read, and errors for a person."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import Annotated, Literal

import pytest

from shared.config import Within, load_config
from shared.errors import ConfigError


class Gait(Enum):
    WALK = "walk"
    CRAWL = "crawl"


@dataclass(frozen=True, slots=True)
class Radio:
    connect: tuple[str, ...] = ("tcp/127.0.0.1:7447",)
    lease_ms: int = 3000
    release_s: float = 1.0


@dataclass(frozen=True, slots=True)
class Site:
    name: str
    height_m: Annotated[float, Within(-500.0, 9000.0)] = 0.0


@dataclass(frozen=True, slots=True)
class Settings:
    unit: str
    rate_hz: Annotated[float, Within(0.1, 1000.0)] = 5.0
    black_box: Path | None = None
    verbose: bool = False
    gait: Gait = Gait.WALK
    level: Literal["INFO", "DEBUG"] = "INFO"
    radio: Radio = field(default_factory=Radio)
    sites: tuple[Site, ...] = ()
    crews: dict[str, Site] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.unit == "all":
            raise ConfigError("unit: 'all' names every unit")


def load(folder: Path, text: str, **flags: object) -> Settings:
    path = folder / "unit.toml"
    path.write_text(text, encoding="utf-8")
    return load_config(path, Settings, flags)


def problem_of(folder: Path, text: str) -> str:
    with pytest.raises(ConfigError) as caught:
        load(folder, text)
    message = str(caught.value)
    assert "unit.toml" in message
    return message


def test_values_of_every_kind_are_read(tmp_path: Path) -> None:
    settings = load(
        tmp_path,
        """
        unit = "anna"
        rate_hz = 4
        black_box = "box"
        verbose = true
        gait = "crawl"
        level = "DEBUG"
        radio.connect = ["tcp/a:1", "tcp/b:2"]
        crews.red = {name = "north", height_m = 3.5}
        [[sites]]
        name = "hall"
        """,
    )
    assert settings == Settings(
        unit="anna",
        rate_hz=4.0,
        black_box=tmp_path / "box",
        verbose=True,
        gait=Gait.CRAWL,
        level="DEBUG",
        radio=Radio(connect=("tcp/a:1", "tcp/b:2")),
        sites=(Site("hall"),),
        crews={"red": Site("north", 3.5)},
    )


def test_flags_overrule_the_file_where_they_are_given(tmp_path: Path) -> None:
    settings = load(
        tmp_path,
        'unit = "anna"\nrate_hz = 2.0\nblack_box = "/var/box"\n[radio]\nlease_ms = 5000',
        **{"rate_hz": 3.0, "radio.connect": ("tcp/c:3",), "unit": None, "black_box": Path("box")},
    )
    assert settings.unit == "anna"
    assert settings.rate_hz == 3.0
    assert settings.black_box == Path("box")
    assert settings.radio == Radio(connect=("tcp/c:3",), lease_ms=5000)


def test_flags_alone_suffice() -> None:
    assert load_config(None, Settings, {"unit": "anna"}) == Settings("anna")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ('unit = "a"\nrate_hs = 5.0', "rate_hs is not a setting; did you mean rate_hz?"),
        ('unit = "a"\nrate_khz = 5.0', "rate_khz is not a setting; its unit is another: rate_hz"),
        ('unit = "a"\n[radio]\nlease_s = 3', "radio.lease_s is not a setting; its unit is another"),
        ('unit = "a"\n[radio]\nconect = []', "radio.conect is not a setting; did you mean connect"),
        ('unit = "a"\n[[sites]]\nnam = "x"', "sites[0].nam is not a setting; did you mean name?"),
        ('unit = "a"\n[crews.red]\nnam = "x"', "crews.red.nam is not a setting"),
        ('unit = "a"\nzzz = 1', "zzz is not a setting; known here: black_box, crews"),
        ("", "unit is missing, and there is no usual value"),
        ("unit = 5", "unit: Expected `str`, got `int`"),
        ('unit = "a"\nrate_hz = "5 Hz"', "rate_hz: Expected `float`, got `str`"),
        ('unit = "a"\nrate_hz = true', "rate_hz: Expected `float`, got `bool`"),
        ('unit = "a"\nrate_hz = 0.0', "rate_hz: Expected `float` >= 0.1"),
        ('unit = "a"\nrate_hz = nan', "rate_hz"),
        ('unit = "a"\nradio = 3', "radio: Expected `object`, got `int`"),
        ('unit = "a"\nblack_box = 3', "black_box"),
        ('unit = "a"\ngait = "craw"', "known: walk, crawl; did you mean crawl?"),
        ('unit = "a"\nlevel = "LOUD"', "known: INFO, DEBUG"),
        ('unit = "all"', "unit: 'all' names every unit"),
        ("unit = ", "not valid TOML"),
    ],
)
def test_a_mistake_is_named_with_what_was_meant(tmp_path: Path, text: str, says: str) -> None:
    assert says in problem_of(tmp_path, text)


def test_every_unknown_key_is_named_at_once(tmp_path: Path) -> None:
    message = problem_of(tmp_path, 'unit = "a"\nrate_hs = 1\n[radio]\nconect = []')
    assert message.count("is not a setting") == 2


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"gone\.toml: there is no such file"):
        load_config(tmp_path / "gone.toml", Settings)


def test_a_file_that_is_no_text_is_named(tmp_path: Path) -> None:
    (tmp_path / "unit.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ConfigError, match=r"unit\.toml: cannot be read"):
        load_config(tmp_path / "unit.toml", Settings)
