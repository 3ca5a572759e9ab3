"""Problems with known answers, stress tests, and the report of error against run time.

A folder holds the cases of one problem or of one method, beside what only they use.
"""
