"""The package as others get it: built by ``python -m build``, installed by ``pip install`` into a clean environment."""

from __future__ import annotations

import os
import subprocess
import sys
import venv
import zipfile
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def run(*command: object, **options: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(list(map(str, command)), cwd=ROOT, capture_output=True, text=True, **options)


@pytest.fixture(scope="module")
def index(tmp_path_factory):
    """An index that answers; what is built needs hatchling from one."""
    place = tmp_path_factory.mktemp("index")
    pip = (sys.executable, "-m", "pip", "--retries", "0", "--timeout", "15", "download", "-q", "--no-deps")
    if find_spec("pip") is None or run(*pip, "-d", place, "hatchling>=1.27").returncode:
        pytest.skip("no Python index answers")


def test_the_package_builds_and_installs_into_a_clean_environment(tmp_path, index):
    """The wheel holds every module, every schema and py.typed; with it alone the lever is exported."""
    if find_spec("build") is not None:
        done = run(sys.executable, "-m", "build", "python", "--outdir", tmp_path)
        assert done.returncode == 0, done.stdout + done.stderr
        (wheel,) = tmp_path.glob("*.whl")
        held = set(zipfile.ZipFile(wheel).namelist())
        package = ROOT / "python" / "src" / "kinefab"
        modules = {f"kinefab/{p.relative_to(package).as_posix()}" for p in package.rglob("*.py")}
        schemas = {f"kinefab/schemas/{p.name}" for p in (ROOT / "schemas").glob("*.json")}
        assert modules | schemas | {"kinefab/py.typed"} <= held and len(list(tmp_path.glob("*.tar.gz"))) == 1
    clean = tmp_path / "clean"
    venv.create(clean, with_pip=True)
    programs = clean / ("Scripts" if os.name == "nt" else "bin")
    done = run(programs / "python", "-m", "pip", "install", "-q", "./python")
    assert done.returncode == 0, done.stdout + done.stderr
    plain = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    source, target = "fixtures/lever/lever.bundle.json", tmp_path / "lever.kinefab"
    done = run(programs / "kinefab", "export", source, "-o", target, "--strict", env=plain)
    assert done.returncode == 0 and target.is_file(), done.stdout + done.stderr
