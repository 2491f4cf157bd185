"""``muster bench track`` and ``muster bench activity``: what the unit makes of a walk, scored."""
