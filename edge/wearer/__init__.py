"""The wearer's button: its drivers, the gestures made with it, and the reader that watches it."""
