"""Accounts: names, roles and passwords of users; their table is ``storage.db.accounts``."""
