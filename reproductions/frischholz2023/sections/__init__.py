"""The sections of the report, one module each: from stored runs to tables, figures and claims."""
