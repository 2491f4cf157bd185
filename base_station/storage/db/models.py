"""The tables.  Times are integer nanoseconds since 1970 (station time), hashes are hex.

A table is either a *projection*, which ``muster base rebuild`` makes again from the log, or
*kept*: people, users, sessions, tokens, what is over of these, and the audit are nowhere else.
"""

from __future__ import annotations

from sqlalchemy import BigInteger, ForeignKey, Index, Integer, LargeBinary, MetaData, String, false
from sqlalchemy.orm import DeclarativeBase, Mapped, mapped_column


class Base(DeclarativeBase):
    metadata = MetaData(
        naming_convention={
            "ix": "ix_%(column_0_label)s",
            "uq": "uq_%(table_name)s_%(column_0_name)s",
            "fk": "fk_%(table_name)s_%(column_0_name)s_%(referred_table_name)s",
            "pk": "pk_%(table_name)s",
        }
    )
    type_annotation_map = {int: BigInteger}  # noqa: RUF012  # SQLAlchemy's way


# ---- kept


class BaseMap(Base):
    """A picture of the ground about the site, and where its corners are; there is one or none."""

    __tablename__ = "base_map"

    image_hash: Mapped[str] = mapped_column(primary_key=True)
    image: Mapped[bytes] = mapped_column(LargeBinary, deferred=True)  # WebP
    corners: Mapped[bytes]  # JSON of ``base_station.site.base_map.Corners``


class PersonRow(Base):
    """Nothing else has a person's name: logs, and what is made of them, have the id."""

    __tablename__ = "people"

    person_id: Mapped[str] = mapped_column(primary_key=True)
    name: Mapped[str]
    crew: Mapped[str]
    role: Mapped[str]
    created_ns: Mapped[int]
    photo: Mapped[bytes | None] = mapped_column(LargeBinary, deferred=True)  # JPEG
    photo_hash: Mapped[str | None]
    removed_ns: Mapped[int | None]  # from the roster; the name stays for incidents of before


class User(Base):
    __tablename__ = "users"

    username: Mapped[str] = mapped_column(primary_key=True)
    password_hash: Mapped[str]
    role: Mapped[str]
    created_ns: Mapped[int]  # with the name, identifies the user; the name may be used again
    generation: Mapped[int] = mapped_column(server_default="0")  # of logins; older ones are over
    role_ns: Mapped[int] = mapped_column(server_default="0")  # since when; of two stations' the
    password_ns: Mapped[int] = mapped_column(server_default="0")  # later holds


class LoginSession(Base):
    __tablename__ = "sessions"

    token_hash: Mapped[str] = mapped_column(primary_key=True)  # SHA-256 of the cookie
    username: Mapped[str] = mapped_column(ForeignKey("users.username", ondelete="CASCADE"))
    created_ns: Mapped[int]
    expires_ns: Mapped[int]
    generation: Mapped[int] = mapped_column(server_default="0")  # its user's when it began


class LoginTransferTicket(Base):
    """Ticket that continues a session at the other station, once."""

    __tablename__ = "hand_overs"

    ticket_hash: Mapped[str] = mapped_column(primary_key=True)  # SHA-256
    session_hash: Mapped[str] = mapped_column(ForeignKey("sessions.token_hash", ondelete="CASCADE"))
    expires_ns: Mapped[int]


class ApiToken(Base):
    __tablename__ = "api_tokens"

    token_id: Mapped[str] = mapped_column(primary_key=True)
    token_hash: Mapped[str] = mapped_column(unique=True)  # SHA-256 of the token
    username: Mapped[str] = mapped_column(ForeignKey("users.username", ondelete="CASCADE"))
    name: Mapped[str]
    role: Mapped[str]  # at most that of its owner
    scopes: Mapped[str] = mapped_column(server_default="")  # separated by spaces; empty: all
    created_ns: Mapped[int]
    expires_ns: Mapped[int | None]
    unit_id: Mapped[str] = mapped_column(server_default="")  # it posts samples of; empty: none


class Tombstone(Base):
    """Mark of a row that was removed for good (``tombstones``): a station that was not connected
    then does not bring it back.
    """

    __tablename__ = "ended"

    what: Mapped[str] = mapped_column(primary_key=True)
    until_ns: Mapped[int | None]  # by itself it would have ended then; None: never


class LostTable(Base):
    """A kept table whose rows this database lost when it was made again: the other station has
    them, until it has given them back.
    """

    __tablename__ = "lost_tables"

    name: Mapped[str] = mapped_column(primary_key=True)


class AuditEntry(Base):
    """Entry of the audit; one of an operator's action carries the action's own id."""

    __tablename__ = "audit"
    __table_args__ = {"sqlite_autoincrement": True}  # noqa: RUF012  # SQLAlchemy's way

    # In the order in which this station got to know; the other station's clock may be another.
    number: Mapped[int] = mapped_column(Integer, primary_key=True)
    entry_id: Mapped[str] = mapped_column(unique=True)
    t_ns: Mapped[int] = mapped_column(index=True)
    by: Mapped[str]
    action: Mapped[str]
    detail: Mapped[str]


OUTDATED_NS = 0  # ``known_ns`` of a copy that an erasure has outdated


class ArchivedIncident(Base):
    """A copy of an incident in an archive; the archive has this and what follows as a file, too."""

    __tablename__ = "archived_incidents"

    incident_id: Mapped[str] = mapped_column(primary_key=True)
    archive: Mapped[str]  # its address
    archived_ns: Mapped[int]
    known_ns: Mapped[int]  # as ``IndexedIncident``; another than there: it is copied once more


class ArchivedObject(Base):
    """A file of a copy."""

    __tablename__ = "archived_objects"

    incident_id: Mapped[str] = mapped_column(primary_key=True)
    name: Mapped[str] = mapped_column(primary_key=True)
    size_bytes: Mapped[int]
    sha256: Mapped[str]
    summary_offset: Mapped[int]  # where the file's own table of contents begins
    topics: Mapped[str]  # JSON, a list


class ArchivedRange(Base):
    """A chunk of such a file: a request for these bytes gives all of that time."""

    __tablename__ = "archived_ranges"

    incident_id: Mapped[str] = mapped_column(primary_key=True)
    name: Mapped[str] = mapped_column(primary_key=True)
    offset: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    size_bytes: Mapped[int]
    from_ns: Mapped[int]
    until_ns: Mapped[int]  # of the last message


# ---- projections of the log


class Unit(Base):
    """A wearable that is registered or has sent a message."""

    __tablename__ = "units"

    unit_id: Mapped[str] = mapped_column(primary_key=True)
    label: Mapped[str]
    registered_ns: Mapped[int | None]  # None: received, but not ours
    last_heard_ns: Mapped[int | None]
    software_version: Mapped[str]
    source: Mapped[str]
    sensor_name: Mapped[str]
    tracker: Mapped[str]
    calibration: Mapped[str]
    has_gps: Mapped[bool]
    # JSON of ``base_station.core.units.worn_sensors.WornSensor``, a list
    sensors: Mapped[str] = mapped_column(server_default="[]")


class IncidentRow(Base):
    __tablename__ = "incidents"

    incident_id: Mapped[str] = mapped_column(primary_key=True)
    name: Mapped[str]
    opened_ns: Mapped[int] = mapped_column(index=True)
    opened_by: Mapped[str]
    closed_ns: Mapped[int | None]
    closed_by: Mapped[str]
    # station time of the newest data that came after the end
    late_data_ns: Mapped[int] = mapped_column("news_ns", server_default="0")
    dispatch_number: Mapped[str] = mapped_column(server_default="")  # empty: opened from none
    site_id: Mapped[str] = mapped_column(server_default="")  # empty: on the station's own site
    # Its members are known; else it is of an earlier version, and everybody was in it.
    has_members: Mapped[bool] = mapped_column(server_default=false())


class IncidentMember(Base):
    """A unit in an incident, from when until when; in one at a time."""

    __tablename__ = "incident_members"

    unit_id: Mapped[str] = mapped_column(primary_key=True)
    from_ns: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    incident_id: Mapped[str] = mapped_column(index=True)
    until_ns: Mapped[int | None]  # None: still


class DispatchRow(Base):
    """The newest report of a dispatch."""

    __tablename__ = "dispatches"

    number: Mapped[str] = mapped_column(primary_key=True)
    updated_ns: Mapped[int]  # time of the change at the dispatch centre; 0: not reported
    report: Mapped[str]  # JSON of ``shared.messages.station.NoteDispatch``


class ImportRow(Base):
    """A file that was brought into an incident (``base_station.storage.imports``)."""

    __tablename__ = "imports"

    incident_id: Mapped[str] = mapped_column(primary_key=True)
    import_id: Mapped[str] = mapped_column(primary_key=True)
    file_name: Mapped[str]  # with references to people, as texts of the log
    format: Mapped[str]
    sha256: Mapped[str]
    size_bytes: Mapped[int]
    shift_s: Mapped[float]
    first_ns: Mapped[int]
    last_ns: Mapped[int]
    t_ns: Mapped[int]  # when it was brought in
    by: Mapped[str]


class Assignment(Base):
    """Wearer of a unit, from when until when; name, crew and role as they were then only where
    the log is of an earlier version, and otherwise empty.
    """

    __tablename__ = "assignments"
    __table_args__ = (Index("ix_assignments_unit_id_from_ns", "unit_id", "from_ns"),)

    action_id: Mapped[str] = mapped_column(primary_key=True)
    unit_id: Mapped[str]
    person_id: Mapped[str]
    person_name: Mapped[str]
    crew: Mapped[str]
    role: Mapped[str]
    from_ns: Mapped[int]
    until_ns: Mapped[int | None]


class AlarmRow(Base):
    """An alarm as it stands."""

    __tablename__ = "alarms"

    alarm_id: Mapped[str] = mapped_column(primary_key=True)
    rule: Mapped[str]
    unit_id: Mapped[str]
    priority: Mapped[int]
    state: Mapped[str]
    level: Mapped[str]
    text: Mapped[str]
    by: Mapped[str]
    raised_ns: Mapped[int] = mapped_column(index=True)
    last_raised_ns: Mapped[int] = mapped_column(server_default="0")  # at first, or anew
    changed_ns: Mapped[int]
    code: Mapped[str] = mapped_column(server_default="")  # empty: of an earlier version
    parameters: Mapped[str] = mapped_column(server_default="{}")  # JSON
    reason: Mapped[str] = mapped_column(server_default="")  # of its resolution, as a code
    note: Mapped[str] = mapped_column(server_default="")
    peak: Mapped[float | None]  # worst value so far of its rule's measure


class AlarmTransition(Base):
    """One change in the life of an alarm."""

    __tablename__ = "alarm_changes"

    alarm_id: Mapped[str] = mapped_column(primary_key=True)
    t_ns: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    state: Mapped[str] = mapped_column(primary_key=True)
    level: Mapped[str] = mapped_column(primary_key=True)
    text: Mapped[str]
    by: Mapped[str]
    code: Mapped[str] = mapped_column(server_default="")
    parameters: Mapped[str] = mapped_column(server_default="{}")
    reason: Mapped[str] = mapped_column(server_default="")  # as above
    note: Mapped[str] = mapped_column(server_default="")
    peak: Mapped[float | None]


class TrackPoint(Base):
    """Place of a unit, at most once a second; NED metres about the site anchor."""

    __tablename__ = "tracks"
    __table_args__ = {"postgresql_partition_by": "RANGE (t_s)"}  # noqa: RUF012  # as above

    unit_id: Mapped[str] = mapped_column(primary_key=True)
    t_s: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)  # whole seconds
    t_ns: Mapped[int]
    north_m: Mapped[float]
    east_m: Mapped[float]
    down_m: Mapped[float]
    std_north_m: Mapped[float]
    std_east_m: Mapped[float]
    std_down_m: Mapped[float]
    heading_rad: Mapped[float]
    floor: Mapped[int | None]
    quality: Mapped[str]


class AnchorRow(Base):
    """Place of the incident frame on the Earth from a time on."""

    __tablename__ = "anchors"

    action_id: Mapped[str] = mapped_column(primary_key=True)
    t_ns: Mapped[int] = mapped_column(index=True)
    lat_deg: Mapped[float]
    lon_deg: Mapped[float]
    height_m: Mapped[float]
    plan_rotation_rad: Mapped[float]
    incident_id: Mapped[str] = mapped_column(server_default="")  # empty: of the station's own site


class PlanRow(Base):
    """The building's plan from then on, as site GeoJSON."""

    __tablename__ = "plans"

    action_id: Mapped[str] = mapped_column(primary_key=True)
    t_ns: Mapped[int] = mapped_column(index=True)
    geojson: Mapped[bytes] = mapped_column(LargeBinary, deferred=True)
    incident_id: Mapped[str] = mapped_column(server_default="")  # as above


class UnitStart(Base):
    """Place where a unit's own frame began, as set by a person."""

    __tablename__ = "starts"

    action_id: Mapped[str] = mapped_column(primary_key=True)
    t_ns: Mapped[int]
    unit_id: Mapped[str] = mapped_column(index=True)
    north_m: Mapped[float]
    east_m: Mapped[float]
    down_m: Mapped[float]
    heading_rad: Mapped[float]


class SmoothedIncident(Base):
    """That trails were smoothed, and when."""

    __tablename__ = "smoothed_incidents"

    incident_id: Mapped[str] = mapped_column(primary_key=True)
    smoother: Mapped[str]
    made_ns: Mapped[int]
    known_ns: Mapped[int] = mapped_column(server_default="0")  # with the news of until then


class IncidentTrails(Base):
    """Trails of one unit, as known afterwards (``base_station.storage.db.smoothed``)."""

    __tablename__ = "incident_trails"

    incident_id: Mapped[str] = mapped_column(primary_key=True)
    unit_id: Mapped[str] = mapped_column(primary_key=True)
    smoothed: Mapped[bytes | None] = mapped_column(LargeBinary)  # None: there is none
    raw: Mapped[bytes | None] = mapped_column(LargeBinary)  # by the unit's own path alone


class PostProcessingCache(Base):
    """The assessment that was worked out once of a closed incident; msgpack of
    ``base_station.replay.assessment.report``.
    """

    __tablename__ = "looked_back"

    incident_id: Mapped[str] = mapped_column(primary_key=True)
    report: Mapped[bytes | None] = mapped_column(LargeBinary)  # None: not assessed yet


class IndexedIncident(Base):
    """The search finds an incident as it was known then (``search_index``)."""

    __tablename__ = "indexed_incidents"

    incident_id: Mapped[str] = mapped_column(primary_key=True)
    known_ns: Mapped[int]  # station time of its newest record; 0: open, or to be indexed again


class SearchTerm(Base):
    """A term by which an incident is found: a word, a person in it, or the rule of an alarm."""

    __tablename__ = "search_terms"

    kind: Mapped[str] = mapped_column(primary_key=True)
    # A word of the place; the id of a person; the name of a rule.  In the order of its bytes:
    # words that begin alike stand beside each other.
    value: Mapped[str] = mapped_column(
        String().with_variant(String(collation="C"), "postgresql"), primary_key=True
    )
    incident_id: Mapped[str] = mapped_column(primary_key=True, index=True)


class LogSegment(Base):
    """One file of the log."""

    __tablename__ = "log_segments"

    name: Mapped[str] = mapped_column(primary_key=True)
    first_ns: Mapped[int]
    last_ns: Mapped[int]
    messages: Mapped[int]
    size_bytes: Mapped[int]
    note: Mapped[str]  # of its recovery; empty: none
    log_id: Mapped[str] = mapped_column(default="", server_default="")  # empty: an earlier version


PROJECTIONS: tuple[type[Base], ...] = (
    Unit,
    IncidentRow,
    IncidentMember,
    DispatchRow,
    ImportRow,
    Assignment,
    AlarmRow,
    AlarmTransition,
    TrackPoint,
    AnchorRow,
    PlanRow,
    UnitStart,
    SmoothedIncident,
    IncidentTrails,
    PostProcessingCache,
    IndexedIncident,
    SearchTerm,
    LogSegment,
)
