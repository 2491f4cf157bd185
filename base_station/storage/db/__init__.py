"""The SQL store: what is queried.  The log is the truth; most tables are a projection of it."""
