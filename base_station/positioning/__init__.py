"""Where everybody is in the incident frame: the fusers of all units, fed and asked."""
