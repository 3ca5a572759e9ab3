"""Questions to many runs: sensitivity, calibration, regression, errors."""
