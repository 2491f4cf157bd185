"""Tracker by the method of Chiu (2011): a torso whose velocity a shank puts right once a stride."""
