"""OndselSolver's assemblies: what its joints mean, and its text format ``.asmt``.

OndselSolver is the solver of FreeCAD's Assembly, so ``joints`` and ``couplings`` speak for both formats.
"""
