"""The plan of the site, and where people can get to on it."""
