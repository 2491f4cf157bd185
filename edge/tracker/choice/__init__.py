"""Choice of the tracker of a person: by where the sensors are worn, or by how they move."""
