"""The bus's router, a process beside the station."""
