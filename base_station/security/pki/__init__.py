"""The station's own certificate authority: who may take part, and as whom.

``PkiFolder`` is all that others need: ``create``, ``enroll``, ``renew``, ``revoke``, and what
the router and the console read from it.  ``docs/security.md`` says what is promised.
"""
