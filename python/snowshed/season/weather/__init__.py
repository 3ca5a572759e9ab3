"""The weather of winters: read, checked, completed, judged, or synthetic."""
