"""The output of commands: tables and notes."""
