"""Who may log in: users' names, roles and passwords; their table is ``storage.db.accounts``."""
