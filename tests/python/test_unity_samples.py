"""The samples of the Unity package are what the exporter writes today, and its script is the exporter's."""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "csharp" / "unity"))

import samples  # noqa: E402

PACKAGE = ROOT / "csharp" / "unity" / "com.kinefab"
SCRIPTS = ROOT / "python" / "src" / "kinefab" / "targets" / "prefab" / "scripts"


def test_coupling_script_is_the_one_that_prefabs_bring():
    """One source and one guid, so that a project may have both."""
    name = "KinefabCoupling.cs"
    assert (PACKAGE / "Runtime" / "Mechanism" / name).read_bytes() == (SCRIPTS / name).read_bytes(), (
        f"copy {SCRIPTS / name} over it"
    )


def test_samples_are_what_the_exporter_writes(tmp_path, monkeypatch):
    committed = samples.SAMPLES
    monkeypatch.setattr(samples, "SAMPLES", tmp_path)
    samples.main()
    written = {path.relative_to(tmp_path): path for path in tmp_path.rglob("*") if path.is_file()}
    assert written
    for name, path in written.items():
        assert (committed / name).read_bytes() == path.read_bytes(), f"{name}: run csharp/unity/samples.py"
    kept = {path.relative_to(committed) for path in committed.rglob("*") if path.is_file()}
    others = {str(name) for name in kept - set(written) if "Prefab" in name.parts[:-1] or ".kinefab" in name.name}
    assert others == {f"{name}.meta" for name in map(str, written) if (committed / f"{name}.meta").is_file()} - {
        str(name) for name in written
    }
