"""What readers share: bytes in, records with places, frames, units, joint frames."""
