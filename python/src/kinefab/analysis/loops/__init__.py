"""Which joints close loops, and the fewest rows that keep them closed."""
