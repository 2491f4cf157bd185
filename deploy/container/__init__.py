"""Container images of a station, a unit and a bucket, and what starts Muster in them."""
