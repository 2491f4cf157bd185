"""The SQL store, for queries.  The log is the truth; most tables are a projection of it."""
