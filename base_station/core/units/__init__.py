"""Messages of units, applied to the state: readings, alerts, exposure to heat, unkept messages."""
