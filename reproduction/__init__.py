"""What reproductions of publications share: claims and verdicts, stages, sections, the report."""
