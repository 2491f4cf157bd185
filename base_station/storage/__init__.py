"""Storage of the station on its disk: the log, its own files, and a copy of them."""
