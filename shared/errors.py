"""Every exception Muster raises on purpose.

    MusterError
      ├─ ConfigError        a setting is unknown, missing or out of range
      ├─ RecordingError     a recording cannot be read as sensor samples
      ├─ WireError          bytes cannot be understood as a message
      │    ├─ UnknownChannelError   no channel has this key
      │    └─ UnknownSchemaError    a schema revision newer than this program
      ├─ BusError           the message bus cannot do what was asked
      │    └─ PortInUseError        another program listens there
      ├─ LogError           a log segment or folder cannot be read or written
      │    └─ DataFolderInUseError  another station writes to this folder
      ├─ StoreError         the database, or a file beside it, cannot do what was asked
      │    ├─ DiskHangsError        its disk does not answer
      │    ├─ DatabaseAwayError     its server does not answer
      │    ├─ DiskFullError         its disk takes nothing: it is full, or can only be read
      │    └─ MemoryLimitError      it would take more memory than it may
      ├─ ArchiveError       an archive of incidents cannot do what was asked
      ├─ LinkRefusedError   a link leads out of a folder
      └─ UserError          a person asked for something impossible

Each message says what happened and what to do about it.
"""

from __future__ import annotations


class MusterError(Exception):
    """Base of every error raised on purpose; its text is meant for a person."""


class ConfigError(MusterError):
    """A setting is unknown, missing or out of range."""


class RecordingError(MusterError):
    """A recording cannot be read as sensor samples."""


class WireError(MusterError):
    """Bytes cannot be understood as a message."""


class UnknownChannelError(WireError):
    """No channel has this key."""


class UnknownSchemaError(WireError):
    """The message was written by a program newer than this one."""


class BusError(MusterError):
    """The message bus cannot do what was asked."""


class PortInUseError(BusError):
    """Another program listens where the bus was to listen."""


class LogError(MusterError):
    """A log segment or folder cannot be read or written."""


class DataFolderInUseError(LogError):
    """Another station writes to this data folder."""


class StoreError(MusterError):
    """The database, or another file that is kept beside it, cannot do what was asked."""


class DiskHangsError(StoreError):
    """The database's disk does not answer: nothing is asked of it until it does."""


class DatabaseAwayError(StoreError):
    """The database's server does not answer: nothing is asked of it until it does."""


class DiskFullError(StoreError):
    """The database's disk takes nothing: it is full, has failed, or can only be read."""


class MemoryLimitError(StoreError):
    """It would take more memory than it may; so it would the next time."""


class ArchiveError(MusterError):
    """An archive of incidents, on a disk or in a bucket, cannot do what was asked."""


class LinkRefusedError(MusterError):
    """A link in a folder leads out of it, and is not followed."""


class UserError(MusterError):
    """A person asked for something impossible."""
