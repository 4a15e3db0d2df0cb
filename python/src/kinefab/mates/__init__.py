"""Mates found from exact geometry: ``find`` reads like a sentence, ``mate`` is the noun, ``mates_file`` what people edit."""

from .mate import AUTO, Mate, Mates, MateSide

__all__ = ["AUTO", "Mate", "MateSide", "Mates"]
