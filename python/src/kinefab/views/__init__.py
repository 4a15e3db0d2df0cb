"""What people look at: a scene in words and in pictures."""
