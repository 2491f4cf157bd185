"""Progress of a command, on a terminal."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager


@contextmanager
def progress_bar(what: str) -> Iterator[Callable[[float], None]]:
    """Progress bar that is shown from the first report until the work is done."""
    from rich.progress import Progress  # noqa: PLC0415  # it takes its time, and may not be shown

    with ExitStack() as shown:
        progress = Progress(transient=True)
        task = progress.add_task(what, total=1.0)

        def report(done: float) -> None:
            if not progress.live.is_started:
                shown.enter_context(progress)
            progress.update(task, completed=done)
            if done >= 1.0:
                shown.close()

        yield report
