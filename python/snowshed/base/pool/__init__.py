"""Work on several processes, with progress, that stops safely."""
