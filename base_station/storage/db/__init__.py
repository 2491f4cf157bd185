"""SQL database, for queries.  The log is the primary record; most tables are a projection of it."""
