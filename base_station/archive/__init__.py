"""Archive of incidents on a disk or in a bucket.  An incident can be shown from it without fetching
all of it.
"""
