"""Plan of the site, and the area that people can reach on it."""
