"""Trust in a position: how far its stated uncertainty holds, unit by unit."""
