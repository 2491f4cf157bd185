"""Archive of incidents on a disk or in a bucket, from which they are shown without all of them."""
