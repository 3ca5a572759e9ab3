"""Snow slides on analytical ground."""
