"""What the source stated beside Unity's fields, for as long as those are what it makes of them."""
