"""Published rows: fixed-lag smoothing, reported covariance and quality."""
