"""The samples of the Unity package are what the exporter writes today, and its script is the exporter's."""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "csharp" / "unity"))

import samples  # noqa: E402
from kinefab.targets.prefab.objects.couplings import script_guid  # noqa: E402

PACKAGE = ROOT / "csharp" / "unity" / "com.kinefab"
SCRIPTS = ROOT / "python" / "src" / "kinefab" / "targets" / "prefab" / "scripts"


def test_coupling_script_is_the_one_that_prefabs_bring():
    """One source; in a namespace of the package's, and by a guid of its own, so that a project may have both."""
    name = "KinefabCoupling.cs"
    brought = (SCRIPTS / name).read_text("utf-8").replace("namespace Kinefab\n", "namespace KinefabUnity\n")
    assert (PACKAGE / "Runtime" / "Mechanism" / name).read_text("utf-8") == brought, "run csharp/unity/samples.py"


def test_package_and_script_share_no_assembly_no_type_and_no_guid():
    """Unity refuses two assemblies of one name, and ignores a package's asset whose guid one of the project's has."""
    ours = {path.stem for path in PACKAGE.rglob("*.asmdef")}
    assert ours and not ours & {path.stem for path in SCRIPTS.glob("*.asmdef")}
    guids = {line for meta in PACKAGE.rglob("*.meta") for line in meta.read_text("utf-8").splitlines() if "guid: " in line}
    assert guids and not guids & {f"guid: {script_guid(path.name)}" for path in SCRIPTS.iterdir()}


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
