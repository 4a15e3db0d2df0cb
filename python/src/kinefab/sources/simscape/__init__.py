"""Simscape Multibody XML 2.0, what the free Simscape Multibody Link writes in Inventor, SolidWorks and Creo."""
