"""What GameObjects refer to and share."""
