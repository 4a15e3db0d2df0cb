"""Writes the add-in: a script, its manifest, and those modules of this package that it runs."""

from __future__ import annotations

import errno
import json
import os
import shutil
from pathlib import Path

from ...diagnostics import schema_directory

NAME = "KinefabCapture"
PACKAGE = Path(__file__).parents[2]
MODULES = (
    "color.py",
    "diagnostics.py",
    "capture/__init__.py",
    "capture/channel.py",
    "capture/draft.py",
    "capture/looks.py",
    "capture/masses.py",
    "capture/patterns.py",
    "capture/writing.py",
    "capture/fusion/__init__.py",
    "capture/fusion/api.py",
    "capture/fusion/capture.py",
    "capture/fusion/inside.py",
    "capture/fusion/joints.py",
    "capture/fusion/occurrences.py",
    "capture/fusion/parts.py",
    "capture/fusion/patterns.py",
)
SCRIPT = '''"""Writes the open design as a CAD bundle of Kinefab, and the raw answers beside it."""

import os
import sys
import traceback

import adsk.core
import adsk.fusion

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "lib"))

from kinefab.capture.fusion.inside import capture_to


def run(context):
    application = adsk.core.Application.get()
    window = application.userInterface
    try:
        dialog = window.createFileDialog()
        dialog.title = "Where the bundle is to be written"
        dialog.filter = "CAD bundle (*.bundle.json)"
        if dialog.showSave() == adsk.core.DialogResults.DialogOK:
            window.messageBox(capture_to(application, dialog.filename))
    except Exception:
        window.messageBox(traceback.format_exc())


def stop(context):
    pass
'''
MANIFEST = {
    "autodeskProduct": "Fusion360",
    "type": "addin",
    "id": "6f1d1c6e-5b0e-4a53-9a53-6b696e656661",
    "author": "Kinefab",
    "description": {"": "Writes the open design as a CAD bundle"},
    "version": "1.0",
    "runOnStartup": False,
    "supportedOS": "windows|mac",
}


def install(folder: Path) -> Path:
    """Write the add-in into a folder for add-ins; the add-in's own folder.  Raises OSError.

    A folder that is not there is not made: Fusion would not look into it.
    """
    if not folder.is_dir():
        fault = errno.ENOTDIR if folder.exists() else errno.ENOENT
        raise OSError(fault, os.strerror(fault), str(folder))
    made = folder / NAME
    library = made / "lib" / "kinefab"
    for module in MODULES:
        target = library / module
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(PACKAGE / module, target)
    (library / "__init__.py").write_text('"""Of Kinefab, what its add-in runs."""\n', encoding="utf-8")
    (library / "schemas").mkdir(exist_ok=True)
    shutil.copyfile(schema_directory() / "diagnostics.json", library / "schemas" / "diagnostics.json")
    (made / f"{NAME}.py").write_text(SCRIPT, encoding="utf-8")
    (made / f"{NAME}.manifest").write_text(json.dumps(MANIFEST, indent=2) + "\n", encoding="utf-8")
    return made
