"""A department: many stations under one roof.  Its bus, tables, API and page."""
