"""Settings of a TAK connection: impossible ones, and ones open to others, are refused at the
start.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from base_station.config import StationConfig
from base_station.forwarders.tak.config import TakConfig
from shared.config import load_config
from shared.errors import ConfigError


@pytest.mark.parametrize(
    "url",
    ["tak.example.org:8089", "http://h:1", "tcp://127.0.0.1", "tcp://:8087", "tcp://h:99999"],
)
def test_text_that_is_no_address_is_refused(url: str) -> None:
    with pytest.raises(ConfigError, match="is no TAK address"):
        TakConfig(url)


@pytest.mark.parametrize("url", ["tcp://192.0.2.7:8087", "udp://239.2.3.1:6969"])
def test_open_connection_beyond_this_machine_needs_an_explicit_setting(url: str) -> None:
    with pytest.raises(ConfigError, match="plain = true"):
        TakConfig(url)
    assert not TakConfig(url, plain=True).is_encrypted


def test_tls_needs_the_certificates_of_both_ends() -> None:
    with pytest.raises(ConfigError, match="needs certificate"):
        TakConfig("tls://tak.test:8089")
    with pytest.raises(ConfigError, match="private_key"):
        TakConfig("tls://tak.test:8089", certificate=Path("c.pem"), ca=Path("ca.pem"))
    with pytest.raises(ConfigError, match="password_file"):
        TakConfig("tls://tak.test:8089", certificate=Path("c.p12"), ca=Path("ca.pem"))


def test_uid_prefix_is_short_and_plain() -> None:
    with pytest.raises(ConfigError, match="uid_prefix"):
        TakConfig("tcp://127.0.0.1:8087", uid_prefix="<a>")


def test_connections_have_names_in_the_settings(tmp_path: Path) -> None:
    file = tmp_path / "station.toml"
    file.write_text(
        '[tak.county]\nurl = "tls://tak.test:8089"\ncertificate = "c.p12"\n'
        'password_file = "p.txt"\nca = "ca.pem"\nteam = "Dark Blue"\n'
    )
    county = load_config(file, StationConfig).tak["county"]
    assert county.certificate == tmp_path / "c.p12"
    assert county.team == "Dark Blue"
    file.write_text('[tak.county]\nurl = "tcp://127.0.0.1:1"\nevery = 1.0\n')
    with pytest.raises(ConfigError, match=r"tak\.county\.every is not a setting.*every_s"):
        load_config(file, StationConfig)
