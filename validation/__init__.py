"""Cases with known answers, stress tests, and the report of error against run time."""
