"""Running scenes: events, results, what happens between events, seasons."""
