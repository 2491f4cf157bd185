"""``muster log``: look into, check, mend and cut the logs of stations and units."""
