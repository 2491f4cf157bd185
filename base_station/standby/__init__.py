"""Two stations: one is active, the other follows its log and takes over when it dies.

``docs/decisions/012-a-standby-follows-the-log-of-the-active-station.md`` gives the reasons,
``docs/standby.md`` the guarantees.  ``Paired`` is for the composition root.
"""
