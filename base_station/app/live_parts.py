"""Parts of a live station, once all of them are made."""

from __future__ import annotations

from dataclasses import dataclass

from base_station.app.factories import Announce
from base_station.app.live_state import LiveState
from base_station.app.resources import Resources
from base_station.app.restart_control import RestartControl
from base_station.app.unit_reports import UnitReports
from base_station.archive.outdated_copies import OutdatedCopies
from base_station.engine.engine import StationEngine
from base_station.engine.ports import EngineGate
from base_station.engine.rate_limiter import SenderRateLimiter
from base_station.engine.sender_bans import SenderBans
from base_station.forwarders.running import Forwarders
from base_station.privacy.erasure_queue import ErasureQueue
from base_station.replay.processes.post_processing_process import PostProcessingProcess
from base_station.replay.processes.server import ReplayProcesses
from base_station.site.plan_reader import PlanReader
from base_station.standby.mode import HaMode


@dataclass(frozen=True)
class LiveParts:
    """Parts of a running station that console and housekeeping use."""

    resources: Resources
    announce: Announce
    live: LiveState
    restarts: RestartControl
    ha_mode: HaMode
    limiter: SenderRateLimiter
    bans: SenderBans
    forwarders: Forwarders
    reports: UnitReports
    engine: StationEngine
    gate: EngineGate  # before the engine
    erasures: ErasureQueue
    outdated_copies: OutdatedCopies
    plans: PlanReader
    replays: ReplayProcesses
    post_processor: PostProcessingProcess
