"""How Unity writes: its YAML, its numbers for objects, its files of importer settings."""
