"""Tracker by the method of Hettiarachchige Don (2016): the hip's velocity modelled step by step."""
