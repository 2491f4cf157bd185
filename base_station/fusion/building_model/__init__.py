"""Building model learnt from paths, where no plan is known: stairs and wall directions."""
