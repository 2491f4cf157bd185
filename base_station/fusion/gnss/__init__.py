"""GNSS fixes before fusion: screening, receiver model, outliers, common-mode error."""
