"""What the package hands out, and that asking for it costs little."""

from __future__ import annotations

import inspect
import re
import subprocess
import sys

import kinefab
from kinefab.model import FREEDOM_NAMES, UNLOCKED

API = """
BatchResult Branching Closures Collider ColliderKind ColliderShape Constraint ConstraintKind Coordinate Coupling Diagnostic
Drive ExportOptions ExportResult Feature FeatureOutcome Freedom Ground Joint JointKind KinefabError MassProperties Mechanism
Motion Outcome PhysicsMaterial Pose Record Report Scene Severity Stop Surface Trajectory __version__ batch export motion
report view
""".split()
"""A name that is added or gone changes what scripts may rely on: write it in CHANGELOG.md too."""


def test_the_public_names_are_those_listed():
    assert sorted(kinefab.__all__) == sorted(API)
    assert all(getattr(kinefab, name) is not None for name in API)


def test_every_public_name_says_what_it_is():
    told = {name: inspect.getdoc(getattr(kinefab, name)) for name in API if name != "__version__"}
    assert [name for name, doc in told.items() if not doc or len(doc) < 20] == []


def test_help_tells_what_each_joint_kind_leaves():
    """It stood in remarks of the source, where ``help`` does not look: a script could not know which axis a slot lies along."""
    told = dict(re.findall(r"^(\w+): (.*)$", inspect.getdoc(kinefab.JointKind) or "", re.MULTILINE))
    words = {kind: set(re.split(r"[;,]", told[kind.value])[0].split()) for kind in UNLOCKED}
    names = {kind: {FREEDOM_NAMES[i] for i in free} or {"none"} for kind, free in UNLOCKED.items()}
    assert words == names and "general" in told


def test_a_shell_offers_every_public_name_and_help_tells_of_it():
    """In a process of its own, where nothing was asked for yet."""
    code = "import sys, kinefab; print(*dir(kinefab)); print('numpy' in sys.modules); help(kinefab)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    offered, numpy, told = done.stdout.split("\n", 2)
    assert set(API) <= set(offered.split()) and numpy == "False"
    shown = [name for name in API if f"\n    {name}(" in told or f"\n    class {name}(" in told]
    assert sorted(shown) == sorted(set(API) - {"__version__"})


def test_importing_the_package_imports_nothing_heavy():
    """``import kinefab`` is for everybody who only might need it; numpy comes with the first name that is used."""
    code = "import sys, kinefab; print(sorted({'numpy', 'scipy', 'trimesh', 'typer', 'rich', 'pxr'} & sys.modules.keys()))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_the_help_of_the_command_line_imports_no_numpy():
    code = "import sys, kinefab.cli; print(sorted({'numpy', 'scipy', 'trimesh', 'pxr'} & sys.modules.keys()))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
