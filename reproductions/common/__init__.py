"""Shared parts of reproductions: declaration, command, stages, claims and verdicts, report."""
