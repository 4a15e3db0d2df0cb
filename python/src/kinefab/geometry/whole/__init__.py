"""Whether a file is all there: cut short, or not fetched at all."""
