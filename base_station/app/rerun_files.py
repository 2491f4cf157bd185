"""Files that a re-run writes: figures, a page with pictures, and its trails for other programs."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import msgspec

from base_station.app.offline_rerun import OpenedRerun, Rerun
from base_station.exporters import exporter_of
from base_station.exporters.incident import incident_tracks
from base_station.replay.assessment.wearers import wearers
from base_station.report.rerun_page import rerun_page
from shared.out_file import whole

TRAILS = "trails.gpx"  # where the site has its place on the Earth


def write_rerun(opened: OpenedRerun, result: Rerun, folder: Path) -> list[str]:
    """Write the files and return their names.  Each is complete or does not exist.  Raises
    UserError.
    """
    worn = wearers(opened.roster, opened.incident, opened.records.members_of(opened.incident))
    names = {unit_id: ", ".join(people) for unit_id, people in worn.items()}
    tracks = incident_tracks(opened.records, opened.roster, opened.incident, result.rerun)
    title = (
        f"tracked again with {result.report.tracker}" if result.report.tracker else "tracked again"
    )
    formats = ["csv", "gpx"] if tracks.anchor is not None else ["csv"]
    page = rerun_page(result.report, opened.plan, result.shown, result.rerun, names)
    contents: dict[str, Iterable[bytes]] = {
        "report.json": [msgspec.json.format(msgspec.json.encode(result.report)), b"\n"],
        "report.html": [page],
        **{f"trails.{one}": exporter_of(one).export(tracks.named_as(title)) for one in formats},
    }
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in contents.items():
        with whole(folder / name) as making, making.open("wb") as file:
            file.writelines(content)
    return list(contents)
