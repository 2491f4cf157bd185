"""Settings of the station: refusals, and messages."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from base_station.config import StationConfig, host_and_port
from shared.config import load_config
from shared.errors import ConfigError


def written(tmp_path: Path, toml: str) -> Path:
    path = tmp_path / "station.toml"
    path.write_text(toml)
    return path


def test_defaults_open_nothing_unencrypted_to_the_network() -> None:
    config = StationConfig()
    assert config.unencrypted_endpoints() == ()
    assert config.configuration_problems() == ()
    config.require_encryption()


def test_unencrypted_bus_is_a_problem_also_on_the_loopback(tmp_path: Path) -> None:
    toml = "[bus]\nlisten = ['tcp/127.0.0.1:7447']\n"
    (problem,) = load_config(written(tmp_path, toml), StationConfig).configuration_problems()
    assert "plain TCP" in problem


@pytest.mark.parametrize(
    ("toml", "reported"),
    [
        ("[http]\nlistne = '127.0.0.1:80'\n", "did you mean"),
        ("[log]\nsegment_min = 15\n", "segment_s"),
        ("[log]\nsegment_s = 0.1\n", "1.0"),
        ("[http]\nlisten = '8080'\n", "HOST:PORT"),
        ("[http]\nlisten = 'localhost:80800'\n", "HOST:PORT"),
        ("[http]\ncertificate = 'a.pem'\n", "give both or neither"),
        ("[bus]\nlisten = ['tls/127.0.0.1']\n", "tls/HOST:PORT"),
        ("[bus]\nlisten = ['127.0.0.1:7447']\n", "tls/HOST:PORT"),
        ("[bus]\nlisten = ['udp/127.0.0.1:7447']\n", "tls/HOST:PORT"),
        ("[standby]\nname = 'b'\npeer = ['10.0.0.2']\n", "tls/HOST:PORT"),
        ("[standby]\nname = 'b'\npeer = ['tls/10.0.0.2:0']\n", "tls/HOST:PORT"),
        ("[standby]\nname = 'b'\npeer = ['tls/10.0.0.2:65536']\n", "tls/HOST:PORT"),
        ("[standby]\nname = 'b'\npeer = ['tls/a..b:7447']\n", "tls/HOST:PORT"),
        ("log_level = 'LOUD'\n", "WARNING"),
    ],
)
def test_wrong_setting_is_named_with_the_right_one(
    tmp_path: Path, toml: str, reported: str
) -> None:
    with pytest.raises(ConfigError) as error:
        load_config(written(tmp_path, toml), StationConfig)
    assert reported in str(error.value)
    assert "station.toml" in str(error.value)


@pytest.mark.parametrize(
    ("bus", "http", "plain"),
    [
        ("tcp/127.0.0.1:7447", "127.0.0.1:8080", ()),
        ("tcp/[::1]:7447", "localhost:8080", ()),
        ("tls/0.0.0.0:7447", "[::]:8080", ("[::]:8080",)),
        ("tcp/0.0.0.0:7447", "127.0.0.1:8080", ("tcp/0.0.0.0:7447",)),
        ("tcp/127.0.0.1:7447#iface=lo", "127.0.0.1:8080", ()),
        ("tcp/[::]:7447?prio=6", "127.0.0.1:8080", ("tcp/[::]:7447?prio=6",)),
        ("tcp/station.local:7447", "10.0.0.1:80", ("tcp/station.local:7447", "10.0.0.1:80")),
    ],
)
def test_unencrypted_connections_from_elsewhere_need_an_explicit_setting(
    tmp_path: Path, bus: str, http: str, plain: tuple[str, ...]
) -> None:
    toml = f"[bus]\nlisten = ['{bus}']\n[http]\nlisten = '{http}'\n"
    config = load_config(written(tmp_path, toml), StationConfig)
    assert config.unencrypted_endpoints() == plain
    if plain:
        with pytest.raises(ConfigError, match="--insecure"):
            config.require_encryption()
    load_config(written(tmp_path, "insecure = true\n" + toml), StationConfig).require_encryption()


def test_address_is_parsed() -> None:
    assert host_and_port("[::1]:80") == ("::1", 80)
    assert host_and_port("station.local:8080") == ("station.local", 8080)


@pytest.mark.slow
def test_settings_are_read_before_slow_steps() -> None:
    """So that a wrong one is reported at once."""
    script = "import sys; import base_station.config; sys.exit('scipy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", script], check=False).returncode == 0
