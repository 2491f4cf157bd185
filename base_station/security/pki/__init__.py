"""The station's own certificate authority: it decides who may take part, and as whom.

``PkiFolder`` is all that others need: ``create``, ``enroll``, ``renew``, ``revoke``, and what
the router and the console read from it.  ``docs/security.md`` has the guarantees.
"""
