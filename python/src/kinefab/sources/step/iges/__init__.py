"""What an IGES file says of itself, read from its text."""
