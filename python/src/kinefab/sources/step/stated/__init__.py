"""What the text of a STEP file states of products and placements, and OpenCASCADE passes over."""
