"""``muster demo``: the whole system on one machine, as processes that meet only on the bus."""

from deploy.demo.program import demo

__all__ = ["demo"]
