"""Report on an incident: one HTML file, or PDF, that is read without the station."""
