"""The CSV of Braun et al. (2020)."""
