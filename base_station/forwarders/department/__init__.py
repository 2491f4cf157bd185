"""Reports of this station to its department: events that are acknowledged, and live summaries."""
