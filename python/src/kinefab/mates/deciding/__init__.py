"""What is one body, and which joint each pair of bodies has: ``decide`` reads like a sentence."""
