"""A scene as one HTML file that plays the mechanism: everything embedded, nothing fetched."""
