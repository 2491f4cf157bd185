"""What the station keeps on its disk: the log, its own files, and a copy of them."""
