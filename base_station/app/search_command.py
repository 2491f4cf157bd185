"""``muster base search``: past incidents by place, person, alarm and date."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated

import typer

from shared.clock import NS_PER_S
from shared.options import End, Start


def search(
    text: Annotated[
        list[str] | None,
        typer.Argument(
            help="Beginnings of words: of name and dispatch, people who were in it, alarms."
        ),
    ] = None,
    data: Path = Path("muster-data"),
    person: Annotated[str, typer.Option(help="Beginnings of one person's name, or the id.")] = "",
    alarm: Annotated[str, typer.Option(help="Beginning of a rule's name, such as mayday.")] = "",
    start: Start = None,
    end: End = None,
    limit: Annotated[int, typer.Option(min=1, help="The newest so many.")] = 50,
) -> None:
    """Find incidents that meet all criteria; case and accents are ignored.

    For an incident that is only in an archive it prints the archive; `muster base archive list`
    prints more about it.
    """
    from base_station.storage.data_folder import DataFolder  # noqa: PLC0415
    from base_station.storage.db.archived import ArchivedCopies  # noqa: PLC0415
    from base_station.storage.db.incident_search import IncidentQuery  # noqa: PLC0415
    from base_station.storage.db.opening import open_database  # noqa: PLC0415
    from base_station.storage.db.records import Records  # noqa: PLC0415
    from base_station.storage.db.roster import Roster  # noqa: PLC0415
    from base_station.storage.db.window import FOREVER_NS, Window  # noqa: PLC0415
    from shared.clock import SystemClock  # noqa: PLC0415

    opened = Window(_ns(start, 0), _ns(end, FOREVER_NS))
    query = IncidentQuery(" ".join(text or ()), person, alarm, opened)
    with open_database(DataFolder(data).require_database()) as store:
        clock = SystemClock()
        roster, copies = Roster(store, clock), ArchivedCopies(store)
        found = Records(store, clock).find_incidents(query, limit)
        archives = copies.archives([one.incident_id for one in found])
        for one in found:
            closed = _shown(one.closed_ns) if one.closed_ns else "open"
            archive = archives.get(one.incident_id, "")
            typer.echo(
                f"{one.incident_id}\t{_shown(one.opened_ns)}\t{closed}\t"
                f"{roster.shown(one.name)}\t{archive}".rstrip()
            )
    typer.echo(f"{len(found)} incidents", err=True)


def _ns(time: datetime | None, default_ns: int) -> int:
    return default_ns if time is None else round(time.timestamp() * 1000) * (NS_PER_S // 1000)


def _shown(t_ns: int) -> str:
    return f"{datetime.fromtimestamp(t_ns / NS_PER_S, UTC):%Y-%m-%d %H:%M:%S}"
