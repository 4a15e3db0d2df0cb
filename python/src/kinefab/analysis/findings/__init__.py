"""What an analysis tells: as data, as a table, as a summary."""
