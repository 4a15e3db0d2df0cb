"""Which objects are Rigidbodies, and what they touch each other with."""
