"""How far joints go: as stated, and as found by moving the mechanism."""
