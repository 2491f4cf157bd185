"""Station time: kept, and told to the units that ask (see docs/clocks.md)."""
