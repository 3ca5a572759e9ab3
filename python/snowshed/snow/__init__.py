"""What is known of snow: relations between its properties, and measuring a stack of it."""
