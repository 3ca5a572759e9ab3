"""Problems with known answers, stress tests, and the report of error against run time.

Each folder holds the cases of one problem or method, and the modules that only these cases use.
"""
