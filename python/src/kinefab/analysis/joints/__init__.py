"""From the relations between bodies to joints."""
