"""Default intervals of accountability: personnel accountability reports (PAR) and work periods."""

from __future__ import annotations

PAR_INTERVAL_S = 20 * 60.0  # departments use 10 to 30 minutes
WORK_LIMIT_S = 40 * 60.0
