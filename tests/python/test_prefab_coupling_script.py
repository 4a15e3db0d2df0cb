"""The script that keeps couplings, compiled against stand-ins of UnityEngine and run."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest
from kinefab.targets.prefab.objects.couplings import FOLDER, SCRIPT

if not (shutil.which("mcs") and shutil.which("mono")):
    pytest.skip("the Mono compiler is not installed (apt-get install mono-mcs)", allow_module_level=True)

OWN = Path(__file__).parent / "coupling_script"
STAND_INS = OWN / "UnityEngine"
LINKS = Path(__file__).parents[1] / "csharp" / "UnityStandIns" / "UnityEngine" / "Articulations.cs"
ELDER, NEWER = "", "UNITY_2022_2_OR_NEWER;UNITY_6000_0_OR_NEWER"


@pytest.fixture(scope="module", params=[ELDER, NEWER], ids=["2021", "6"])
def program(request, tmp_path_factory) -> Path:
    """The script and the test's gear pair, compiled against the stand-ins of UnityEngine."""
    folder = tmp_path_factory.mktemp("script")
    sources = [LINKS, *sorted(STAND_INS.glob("*.cs"))]
    out = folder / "gear.exe"
    define = [f"-define:{request.param}"] if request.param else []
    command = [
        "mcs",
        "-langversion:7",
        "-warnaserror+",
        "-nowarn:0649",
        *define,
        f"-out:{out}",
        *map(str, sources),
    ]
    command += [
        str(FOLDER / SCRIPT),
        *(
            str(OWN / f"{name}.cs")
            for name in ("MotionStandIns", "GearPair", "Links", "Slide", "Several", "Release", "Recompiled")
        ),
    ]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return out


@pytest.mark.parametrize(
    "how",
    [
        "moved",
        "hinge",
        "configurable",
        "driven slide",
        "swapped slide",
        "moved slide",
        "from slide",
        "moved screw",
        "late moved",
        "late hinge",
        "recompiled moved",
        "recompiled hinge",
        "recompiled configurable",
        "two turns",
        "swapped two turns",
        "other terms",
        "wakes",
    ],
)
def test_a_gear_pair_keeps_its_ratio_over_a_thousand_steps(program, how):
    """Degrees that it is off, and millimetres that it leaves its axle: float32 is all there is.  Slides too, which count from the
    pose of the prefab and not from where their anchors meet; a component that is enabled late, and one whose script is compiled
    anew while the editor plays; two on one joint, about two of its axes; and one whose terms change on the way.  A body that sleeps is woken when it has to follow, and then alone."""
    done = subprocess.run(["mono", str(program), how], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) < 2e-3


@pytest.mark.parametrize(
    "how",
    [
        "links",
        "links recompiled",
        "links of slides",
        "link by a joint",
        "joint by a link",
        "links awake",
        "links free",
        "links free broken",
    ],
)
def test_links_keep_their_ratio_whichever_of_the_two_is_one(program, how):
    """Degrees or millimetres that the driven link is off over six turns, its position read within two of them as PhysX keeps it; nothing
    is asked of a link more than half a turn away.  One that sleeps is woken; released, it has its own drive and the limits of then."""
    done = subprocess.run(["mono", str(program), how], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) < 2e-3


@pytest.mark.parametrize(
    "how", ["free hinge", "free configurable", "free broken hinge", "free broken configurable"]
)
def test_a_joint_that_is_driven_no_longer_has_its_own_drives_again(program, how):
    """The component is disabled, as a clutch opens, or the joint that leads has broken."""
    done = subprocess.run(["mono", str(program), how], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) == 0
