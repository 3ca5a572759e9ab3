"""Reproductions of publications: each declares sizes, stages, claims and sections.

`reproductions.common` turns a declaration into a command and a report.
"""
