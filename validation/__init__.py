"""Problems with known answers, stress tests, and the report of error against run time.

A folder holds the cases of one problem or of one method, and the modules that only they use.
"""
