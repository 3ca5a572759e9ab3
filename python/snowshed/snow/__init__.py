"""Snow: relations between its properties, and the measurement of a stack."""
