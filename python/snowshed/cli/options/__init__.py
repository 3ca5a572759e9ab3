"""Options of commands, and their values."""
