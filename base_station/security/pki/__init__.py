"""Certificate authority of the station: it issues the identities of all participants.

``PkiFolder`` is all that others need: ``create``, ``enroll``, ``renew``, ``revoke``, and what
the router and the console read from it.  ``docs/security.md`` has the guarantees.
"""
