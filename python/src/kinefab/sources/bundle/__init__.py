"""The CAD bundle, as JSON and as tagged CSV."""
