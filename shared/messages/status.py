"""Status of the wearer and of the unit."""

from __future__ import annotations

from enum import IntEnum

import msgspec

from shared.messages.header import Header
from shared.messages.known import known
from shared.messages.muster.v1 import status_pb2
from shared.messages.quantise import signed32, unsigned32
from shared.messages.temperature import SensorTemperature


class Activity(IntEnum):
    UNKNOWN = 0
    STILL = 1
    WALKING = 2
    RUNNING = 3
    STAIRS_UP = 4
    STAIRS_DOWN = 5
    CRAWLING = 6
    LYING = 7
    FALLING = 8


class BodyPosture(IntEnum):
    UNKNOWN = 0
    UPRIGHT = 1  # standing, sitting or kneeling
    STANDING = 2
    SITTING = 3
    KNEELING = 4
    CRAWLING = 5  # on hands and knees
    BENT = 6  # on the feet, the trunk bent forward
    LYING = 7  # on whichever side
    PRONE = 8  # lying, the face down
    SUPINE = 9  # lying on the back
    LEFT_SIDE = 10  # lying on it
    RIGHT_SIDE = 11


class Mobility(IntEnum):
    """Way of moving about, against the way the body faces."""

    UNKNOWN = 0
    STILL = 1
    MOVING = 2  # which way is not known
    FORWARD = 3
    BACKWARD = 4
    LEFTWARD = 5  # side steps
    RIGHTWARD = 6
    TURNING = 7  # on the spot


class BatteryState(IntEnum):
    UNKNOWN = 0
    DISCHARGING = 1
    CHARGING = 2
    FULL = 3  # on external power, and not charging


class Status(msgspec.Struct, frozen=True, gc=False):
    header: Header
    activity: Activity
    motionless_s: float  # since the last motion
    battery: float | None  # 0 empty ... 1 full; None: the unit cannot tell
    mayday: bool  # the wearer's button is latched
    steps: int
    cadence_hz: float  # steps a second
    floors_climbed: int  # net, up positive
    tracker_rows_dropped: int
    journal_pending: int  # messages written but not known to have arrived
    electronics: tuple[SensorTemperature, ...] = ()  # inside the unit; not the air around it
    battery_left_s: int | None = None  # until the battery is empty; None: unknown
    battery_state: BatteryState = BatteryState.UNKNOWN
    battery_name: str = ""  # of several the emptiest; empty: that of the sensor
    posture: BodyPosture = BodyPosture.UNKNOWN
    posture_confidence: float = 0.0  # its probability, 0 ... 1
    mobility: Mobility = Mobility.UNKNOWN

    def to_wire(self) -> status_pb2.Status:
        return status_pb2.Status(
            header=self.header.to_wire(),
            activity=int(self.activity),  # type: ignore[arg-type]  # stubs want the generated enum
            motionless_ds=unsigned32(self.motionless_s, 10.0),
            battery_permille=0 if self.battery is None else unsigned32(self.battery, 1e3),
            battery_known=self.battery is not None,
            mayday=self.mayday,
            steps=self.steps,
            cadence_mhz=unsigned32(self.cadence_hz, 1e3),
            floors_climbed=signed32(self.floors_climbed, 1.0),
            tracker_rows_dropped=self.tracker_rows_dropped,
            journal_pending=self.journal_pending,
            electronics=[sensor.to_wire() for sensor in self.electronics],
            battery_left_s=self.battery_left_s or 0,
            battery_state=int(self.battery_state),  # type: ignore[arg-type]  # as above
            battery_name=self.battery_name,
            posture=int(self.posture),  # type: ignore[arg-type]  # as above
            posture_permille=unsigned32(self.posture_confidence, 1e3),
            mobility=int(self.mobility),  # type: ignore[arg-type]  # as above
        )

    @staticmethod
    def from_wire(wire: status_pb2.Status) -> Status:
        return Status(
            header=Header.from_wire(wire.header),
            activity=known(Activity, wire.activity),
            motionless_s=wire.motionless_ds * 0.1,
            battery=wire.battery_permille * 1e-3 if wire.battery_known else None,
            mayday=wire.mayday,
            steps=wire.steps,
            cadence_hz=wire.cadence_mhz * 1e-3,
            floors_climbed=wire.floors_climbed,
            tracker_rows_dropped=wire.tracker_rows_dropped,
            journal_pending=wire.journal_pending,
            electronics=tuple(map(SensorTemperature.from_wire, wire.electronics)),
            battery_left_s=wire.battery_left_s or None,
            battery_state=known(BatteryState, wire.battery_state),
            battery_name=wire.battery_name,
            posture=known(BodyPosture, wire.posture),
            posture_confidence=wire.posture_permille * 1e-3,
            mobility=known(Mobility, wire.mobility),
        )
