"""North and east of one unit: filter, headings, compass, walls, landmarks."""
