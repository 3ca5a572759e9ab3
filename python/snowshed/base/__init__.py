"""What every room uses: records, arrays, texts, notes, the pool of processes."""
