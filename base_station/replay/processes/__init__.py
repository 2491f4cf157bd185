"""Processes of their own for what looks at the past: what is live does not share an interpreter,
nor its memory, with them.
"""
