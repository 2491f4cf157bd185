"""A PostgreSQL server proves who it is by a certificate; one that does not is told from one that is
away.
"""

from __future__ import annotations

from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from base_station.security.pki.certificates import Issued, issue, make_authority
from base_station.storage.db.roster import Roster
from base_station.storage.db.server_address import ServerAddress
from base_station.storage.db.server_store import ServerStore
from shared.clock import SystemClock
from shared.coded_text import code_of_text
from shared.enrolment import Holder
from shared.errors import DatabaseAwayError
from tests.rig.database_server import DatabaseServer, database_server
from tests.rig.waiting import until

_DAY = timedelta(days=1)
_NOW = datetime.now(UTC)
_CITY = make_authority("City", _NOW - 100 * _DAY, 1000 * _DAY)
_COUNTY = make_authority("County", _NOW - 100 * _DAY, 1000 * _DAY)
HOST = "db.example"


def certificate(authority: Issued = _CITY, *, began: datetime = _NOW, days: int = 30) -> Issued:
    return issue(authority, "database", Holder.STATION, began, days * _DAY, hosts=[HOST])


EXPIRED = certificate(began=_NOW - 50 * _DAY)


@pytest.fixture(scope="module")
def server() -> Iterator[DatabaseServer]:
    with database_server() as server:
        yield server


@pytest.fixture
def place(server: DatabaseServer, tmp_path: Path) -> ServerAddress:
    """A database, asked over the socket."""
    server.stop()
    server.start()
    (tmp_path / "city.pem").write_bytes(_CITY.certificate_pem())
    (tmp_path / "county.pem").write_bytes(_COUNTY.certificate_pem())
    return server.new_database(tmp_path)


def over_tls(
    server: DatabaseServer, place: ServerAddress, *, host: str = HOST, asked: str = ""
) -> ServerAddress:
    """``asked``: of the certificate, as in the address; the default is ``verify-full``."""
    name = place.url.split("/")[3].split("?")[0]
    folder = Path(place.password_file).parent
    url = f"postgresql+psycopg://fire@{host}:{server.port}/{name}?hostaddr=127.0.0.1"
    return ServerAddress(url + asked.format(folder=folder), place.password_file)


CITY, COUNTY = "&sslrootcert={folder}/city.pem", "&sslrootcert={folder}/county.pem"
VERIFY_CA = "&sslmode=verify-ca"


@pytest.mark.parametrize(
    ("shown", "host", "asked"),
    [
        (certificate(), HOST, CITY),
        (certificate(), HOST, CITY + VERIFY_CA),
        (certificate(), "other.example", CITY + VERIFY_CA),
        (EXPIRED, HOST, "&sslmode=require"),
    ],
)
def test_server_is_used_that_proves_what_the_address_asks_for(
    server: DatabaseServer, place: ServerAddress, shown: Issued, host: str, asked: str
) -> None:
    server.stop()
    server.start(shown)
    with ServerStore(over_tls(server, place, host=host, asked=asked), is_station=True) as store:
        Roster(store, SystemClock()).add_person("Ada", "", "")
        with store.engine.connect() as connection:
            encrypted = "SELECT ssl FROM pg_stat_ssl WHERE pid = pg_backend_pid()"
            assert connection.exec_driver_sql(encrypted).scalar() is True


@pytest.mark.parametrize(
    ("shown", "host", "asked", "words"),
    [
        (certificate(), "other.example", CITY, r'for "db.example".*write the name that it is for'),
        (certificate(), HOST, COUNTY, "another authority than that of sslrootcert"),
        (certificate(), HOST, COUNTY + VERIFY_CA, "another authority than that of sslrootcert"),
        (EXPIRED, HOST, CITY, r"it has expired.*see its dates"),
        (EXPIRED, HOST, CITY + VERIFY_CA, r"it has expired.*see its dates"),
        (certificate(), HOST, "&sslrootcert=/none.pem", r"/none.pem.*give its certificate, as PEM"),
        (None, HOST, CITY, "turn on ssl at the server"),
    ],
)
def test_server_is_refused_that_does_not_prove_it(
    server: DatabaseServer,
    place: ServerAddress,
    shown: Issued | None,
    host: str,
    asked: str,
    words: str,
) -> None:
    server.stop()
    server.start(shown)
    with pytest.raises(DatabaseAwayError, match=words) as refused:
        ServerStore(over_tls(server, place, host=host, asked=asked), is_station=True)
    assert server.password not in str(refused.value)
    assert "user and password" not in str(refused.value)


def test_certificate_that_expires_meanwhile_is_a_problem_until_there_is_another(
    server: DatabaseServer, place: ServerAddress
) -> None:
    server.stop()
    server.start(certificate())
    with ServerStore(over_tls(server, place, asked=CITY), is_station=True) as store:
        roster = Roster(store, SystemClock())
        roster.add_person("Ada", "", "")
        server.stop()
        server.start(EXPIRED)
        with pytest.raises(DatabaseAwayError):
            roster.add_person("Bo", "", "")
        until(lambda: "certificate" in asked_again(store), "the reason is the certificate")
        code = code_of_text(store.problem)
        assert (code.code, code.texts["reason:"]) == (
            "database-away",
            "database-certificate-refused",
        )
        server.stop()
        server.start(certificate())
        until(lambda: asked_again(store) == "", "it is used again")
        roster.add_person("Bo", "", "")


def asked_again(store: ServerStore) -> str:
    store.check_disk()
    return store.problem
