"""What a running CAD program says of its open assembly, written as a CAD bundle.

One room a program, each written against ``api.py``: exactly the members it uses, with unit, frame and page.  ``channel`` asks and
keeps every answer, ``draft`` gathers a bundle's records, ``masses``, ``looks`` and ``patterns`` make those that are alike in all
programs, ``checking`` evaluates them at the captured pose and tries the other ``readings``, ``comparing`` holds the program's own
rigid bodies and freedoms against the analysis, ``writing`` writes.  Not yet run inside the programs.

Calls of an assembly of 2,000 occurrences and 5,000 constraints, linear (``tests/python/test_capture_cost.py``): Inventor 220,024,
SolidWorks 115,027, each about a millisecond out of process; Fusion 141,031 with 5,000 joints, in process; Onshape four, two for
each part and one for each Part Studio, one for each assembly inside; one more for a part whose mass does not tell how its mesh stands.
"""
