"""Clock of a device, mapped to this machine's clock by when its messages come.

A message arrives after its time, never before: the least delay of the last seconds is the
offset, up to the delay of the quickest message.  The offset follows the device's drift slowly, so
that intervals between samples stay the device's own.  Where the device's clock was set, restarted
or wrapped, the offset begins anew, and the event is reported; one message alone does not do this,
because noise on a line can look like any time.
"""

from __future__ import annotations

from shared.clock import NS_PER_S
from shared.coded_text import coded

_JUMP_NS = NS_PER_S  # more than this ahead of now is another clock
_BACK_NS = NS_PER_S // 10  # less is a message that was overtaken
_WINDOW_NS = 10 * NS_PER_S
_SLEW = 0.001  # of elapsed time: far less than scale errors, far more than a crystal is off


class DeviceClock:
    """Mapping; ``place`` the times of messages as they come; the result only ever goes forward."""

    def __init__(self) -> None:
        self._offset_ns: int | None = None
        self._last_device_ns: int | None = None
        self._last_ns: int | None = None
        self._unconfirmed_ns: int | None = None  # a time that the next message may confirm
        self._since_ns = 0  # device time at which the window began
        self._least_ns = self._least_before_ns = 0  # delay and offset in one
        self._events: list[str] = []
        self.repeated = 0  # messages of a time that had been
        self.implausible = 0  # messages whose time fitted nothing

    def reopened(self) -> None:
        """Start again: the delay of messages is to be learned anew after the line was cut."""
        self._offset_ns = None
        self._unconfirmed_ns = None

    def take_events(self) -> list[str]:
        """Return what happened to the device's clock since the last call, for a person."""
        take_events, self._events = self._events, []
        return take_events

    def place(self, device_ns: int, arrival_ns: int) -> int | None:
        """Return this machine's monotonic time of a sample; None of one that has no place."""
        if self._last_device_ns is not None and not self._can_be_placed(device_ns, arrival_ns):
            return None
        self._note(device_ns, arrival_ns)
        assert self._offset_ns is not None
        t_ns = device_ns + self._offset_ns
        if self._last_ns is not None and t_ns <= self._last_ns:
            self._offset_ns += self._last_ns + 1 - t_ns
            t_ns = self._last_ns + 1
        self._last_ns = t_ns
        return t_ns

    def _can_be_placed(self, device_ns: int, arrival_ns: int) -> bool:
        """Return True if the sample can be placed; after a jump, from the second one on."""
        assert self._last_device_ns is not None
        step_ns = device_ns - self._last_device_ns
        back = step_ns < -_BACK_NS
        ahead = self._offset_ns is not None and (
            device_ns + self._offset_ns - arrival_ns > _JUMP_NS and step_ns > _JUMP_NS
        )
        if back or ahead:
            if not self._is_confirmed(device_ns):
                self._unconfirmed_ns = device_ns
                self.implausible += 1
                return False
            self._report_jump(step_ns)
            self._offset_ns = None
            return True
        self._unconfirmed_ns = None
        if step_ns <= 0:
            self.repeated += 1
            return False
        return True

    def _is_confirmed(self, device_ns: int) -> bool:
        return self._unconfirmed_ns is not None and 0 < device_ns - self._unconfirmed_ns < _JUMP_NS

    def _report_jump(self, step_ns: int) -> None:
        self._unconfirmed_ns = None
        if step_ns < 0:
            self._events.append(
                coded(
                    "device-clock-back",
                    "its clock went back by {step_s:.1f} s: it was started anew, or set; time goes "
                    "on from now",
                    step_s=-step_ns / NS_PER_S,
                )
            )
        else:
            self._events.append(
                coded(
                    "device-clock-ahead",
                    "its clock went ahead by {step_s:.1f} s: it was set; time goes on from now",
                    step_s=step_ns / NS_PER_S,
                )
            )

    def _note(self, device_ns: int, arrival_ns: int) -> None:
        """Learn the delay of this message, and follow."""
        late_ns = arrival_ns - device_ns
        if self._offset_ns is None or self._last_device_ns is None:
            self._offset_ns = self._least_ns = self._least_before_ns = late_ns
            self._since_ns = self._last_device_ns = device_ns
            return
        if device_ns - self._since_ns > _WINDOW_NS:
            self._since_ns = device_ns
            self._least_before_ns, self._least_ns = self._least_ns, late_ns
        self._least_ns = min(self._least_ns, late_ns)
        apart_ns = min(self._least_ns, self._least_before_ns) - self._offset_ns
        if apart_ns > _JUMP_NS:
            self._events.append(
                coded(
                    "device-samples-late",
                    "its samples have come {late_s:.1f} s late for {within_s:.0f} s: the line is "
                    "too slow for them, or its clock was set",
                    late_s=apart_ns / NS_PER_S,
                    within_s=_WINDOW_NS / NS_PER_S,
                )
            )
            self._offset_ns += apart_ns
        else:
            most_ns = round(_SLEW * (device_ns - self._last_device_ns))
            self._offset_ns += max(-most_ns, min(most_ns, apart_ns))
        self._last_device_ns = device_ns
