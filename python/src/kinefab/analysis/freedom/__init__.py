"""What equations leave free: rank, twists, and which of them grow into finite motions."""
