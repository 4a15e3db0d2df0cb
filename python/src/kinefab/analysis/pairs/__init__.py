"""Any two bodies that constraints join: what is left between them, and which joint that is."""
