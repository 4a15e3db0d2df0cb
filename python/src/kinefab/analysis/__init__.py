"""From constraints to freedoms, to the joint between any two parts."""

from ..options import Closures
from .analyse import AnalysisOptions, analyse
from .result import Analysis, Island, NodeFreedom

__all__ = ["Analysis", "AnalysisOptions", "Closures", "Island", "NodeFreedom", "analyse"]
