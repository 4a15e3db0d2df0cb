"""From constraints to freedoms, to the joint between any two parts.

``analyse`` is the whole road, step by step.  Which step stands where:

* What a constraint says: ``constraints`` (every pairing), of ``atoms``, ``distances``, ``tangency``, ``coupled``;
  geometry brought into the world by ``features``.
* As numbers: ``scene_equations`` writes a scene's statements, the alike ones in stacks (``building``), through ``rows``
  into a ``system``; ``duplicates`` counts what is said twice once.
* In which order: ``canonical``, so that no name and no source's order decides.
* Poses: ``solve`` (Gauss-Newton), ``closing`` (does the exported pose fit), ``driving`` (along stated coordinates:
  ``walk`` from knot to knot, ``way`` with what ends it, ``mechanism`` by names).
* Freedoms: ``rank``, ``first_order`` (block by ``blocks``), ``motion`` (finite), ``idle`` (by ``tied`` parts), ``freedoms``
  (of each part against ground).
* Joints: ``pairs`` and ``effective`` by ``twists``, ``candidates`` and the ``finite`` test; ``jointing`` to the
  ``links`` that Unity can have; ``resolving`` what is no one joint's twists, with ``middle`` bodies; ``rehanging``.
* The mechanism: ``bodies`` and ``assembly`` (rigid groups), ``loops``, ``minimal`` closures, ``couplings``.
* How far it goes: ``ranges`` that the source states; ``limits`` found along the ``curve`` of one freedom or, of several,
  by each joint's ``reach``, both over ``measured`` coordinates.
* ``result`` and ``summary`` tell it.
"""

from ..options import Closures
from .analyse import AnalysisOptions, analyse
from .findings.result import Analysis, Island, NodeFreedom

__all__ = ["Analysis", "AnalysisOptions", "Closures", "Island", "NodeFreedom", "analyse"]
