"""Two stations: one is active, the other follows its log and takes over when it dies.

``docs/decisions/012-a-standby-follows-the-log-of-the-active-station.md`` says why it is done this
way, ``docs/standby.md`` what is promised.  ``Paired`` is what the composition root works with.
"""
