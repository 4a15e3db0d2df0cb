"""Where two parts touch or are held apart by a clearance."""
