"""``muster bench fusion``: how well the station knows where people are."""
