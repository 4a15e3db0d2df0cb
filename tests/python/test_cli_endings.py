"""How files end, whatever the capitals: of what is written, of what is read, of what is looked at.  How the program ends."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys

import pytest
from command_line import LEVER, run

pytest.importorskip("pxr", reason="usd-core is not installed")


@pytest.mark.parametrize(
    "name, written",
    [
        ("Robot.KINEFAB", "Robot.KINEFAB"),
        ("Robot.GLB", "Robot.GLB"),
        ("Robot.USDA", "Robot.USDA"),
        ("Robot.UsdZ", "Robot.UsdZ"),
        ("Robot.UnityPackage", "Robot.UnityPackage"),
        ("Robot.PREFAB", "Robot.prefab"),  # Unity's own writing, beside which the metas stand
    ],
)
def test_a_target_in_capitals(tmp_path, name, written):
    done = run("export", str(LEVER), "-o", str(tmp_path / name))
    assert done.returncode == 0, done.stdout + done.stderr
    assert (tmp_path / written).is_file() and written in (done.stdout + done.stderr)
    assert (tmp_path / "Robot").is_dir() is (written == "Robot.prefab")


def test_sources_and_pictures_in_capitals(tmp_path):
    """The same scene, whatever the capitals; a USD stage too, which the library opens by its ending."""
    folder = tmp_path / "in"
    shutil.copytree(LEVER.parent, folder)
    (folder / LEVER.name).rename(folder / "LEVER.BUNDLE.JSON")
    for source in ("LEVER.BUNDLE.JSON", "LEVER.USDC"):
        scene = tmp_path / "Lever.KINEFAB"
        if source.endswith("USDC"):
            assert run("export", str(LEVER), "-o", str(folder / source)).returncode == 0
        done = run("export", str(folder / source), "-o", str(scene))
        assert done.returncode == 0, done.stdout + done.stderr
        assert run("inspect", str(scene)).returncode == 0
        for command, page in (("draw", "L.SVG"), ("view", "L.HTML")):
            done = run(command, str(scene), "-o", str(tmp_path / page))
            assert done.returncode == 0 and (tmp_path / page).stat().st_size > 1000, done.stdout + done.stderr


@pytest.mark.skipif(os.name == "nt", reason="Windows sends no signal to one process alone")
@pytest.mark.parametrize("ignored", [False, True])
def test_ctrl_c_while_the_program_is_still_imported(ignored):
    """It ends by the signal, with no traceback; a job in the background, which has it ignored, goes on."""
    code = (
        "import os, runpy, signal, sys\n"
        f"signal.signal(signal.SIGINT, signal.SIG_IGN if {ignored} else signal.default_int_handler)\n"
        "class Stopping:\n"
        "    def find_spec(self, name, *_):\n"
        "        if name == 'typer':\n"
        "            os.kill(os.getpid(), signal.SIGINT)\n"
        "sys.meta_path.insert(0, Stopping())\n"
        "sys.argv = ['kinefab', '--version']\n"
        "runpy.run_module('kinefab', run_name='__main__')"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.stderr == "" and done.returncode == (0 if ignored else -signal.SIGINT)
