"""Files in and out, and the values, tables and messages in them."""
