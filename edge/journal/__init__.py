"""Everything a unit says: on its disk before it is on the air, and until the station has it."""
