"""Program of the live station: runs it, and restarts it on request."""

from __future__ import annotations

import os
from contextlib import ExitStack
from subprocess import Popen

from base_station.app.factories import Announce
from base_station.app.folder_commands import cut_log
from base_station.app.pipeline_factory import require_fuser
from base_station.app.resources import open_station
from base_station.app.restart_control import Restart
from base_station.app.running_station import RunningStation
from base_station.config import StationConfig
from base_station.core.alarms import ALARMS
from base_station.core.alarms.thresholds import Thresholds, thresholds_of
from base_station.process import gc_tuning
from base_station.process.open_files import allow_many_files
from base_station.process.shutdown_watchdog import ShutdownWatchdog
from base_station.radio.config import require_channel_names
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.data_folder import DataFolder
from shared.service_manager import ServiceManager


def run_station(
    config: StationConfig, announce: Announce, loading_router: Popen[str] | None = None
) -> None:
    """Run the live station until SIGINT or SIGTERM. ``announce`` receives lines for a person;
    ``loading_router`` becomes the first router of the bus.

    Raises ConfigError if a threshold of the settings is not valid for its alarm rule, if there is
    no such fuser, or if a radio channel has an invalid name.
    """
    require_fuser(config.positioning.fuser)
    require_channel_names(config.radio)
    thresholds = thresholds_of(ALARMS, config.alarms)
    gc_tuning.configure()
    allow_many_files()
    manager = ServiceManager(os.environ)

    def show(line: str) -> None:
        announce(line)
        manager.working()

    while (restart := _run_once(config, thresholds, show, manager, loading_router)) is not None:
        loading_router = None
        gc_tuning.unfreeze()
        if restart.cut_from is not None:
            show("what the other station does not have is set aside, and handed to it")
            cut_log(config.data, restart.cut_from, lambda _: manager.working())
        if restart.is_repaired:
            show("what the disk had lost of the log is there again, and is stepped")
            Checkpoints(DataFolder(config.data).checkpoints).clear()


def _run_once(
    config: StationConfig,
    thresholds: Thresholds,
    announce: Announce,
    manager: ServiceManager,
    loading_router: Popen[str] | None,
) -> Restart | None:
    with ShutdownWatchdog() as end, ExitStack() as closing:
        resources = open_station(config, announce, closing, loading_router)
        return RunningStation(resources, thresholds, announce, manager, end, closing).run()
