"""Sources and targets in an S3 bucket, by a server of moto's in this process, which the converting processes reach too."""

from __future__ import annotations

import shutil
import urllib.request
from pathlib import Path

import kinefab
import pytest

pytest.importorskip("moto", reason="the Python package moto is not installed")
pytest.importorskip("flask", reason="moto's server is not installed: pip install moto[s3] flask flask-cors")
s3fs = pytest.importorskip("s3fs", reason="the Python package s3fs is not installed")

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"


@pytest.fixture
def bucket(monkeypatch):
    """A file system with the bucket ``plant``."""
    from moto.server import ThreadedMotoServer

    server = ThreadedMotoServer("127.0.0.1", port=0, verbose=False)
    server.start()
    host, port = server.get_host_and_port()
    for name, value in {
        "AWS_ENDPOINT_URL": f"http://{host}:{port}",
        "AWS_ACCESS_KEY_ID": "testing",
        "AWS_SECRET_ACCESS_KEY": "testing",
        "AWS_DEFAULT_REGION": "us-east-1",
        "no_proxy": "127.0.0.1",
    }.items():
        monkeypatch.setenv(name, value)
    s3fs.S3FileSystem.clear_instance_cache()
    system = s3fs.S3FileSystem()
    system.mkdir("plant")
    yield system
    s3fs.S3FileSystem.clear_instance_cache()
    urllib.request.urlopen(
        urllib.request.Request(f"http://{host}:{port}/moto-api/reset", method="POST")
    ).close()
    server.stop()


def outcomes(result: kinefab.BatchResult) -> dict[str, str]:
    return {record.source.rpartition("/")[2]: record.outcome.value for record in result.records}


def test_a_bucket_is_converted_skipped_and_gone_on_with(bucket, tmp_path):
    """The scene of a bucket is byte for byte that of a folder; a mesh beside a source counts as read."""
    for name in ("lever.bundle.json", "lever.obj", "lever.mtl"):
        bucket.put_file(str(FIXTURES / "lever" / name), f"plant/in/{name}")
        shutil.copy(FIXTURES / "lever" / name, tmp_path / name)
    bucket.put_file(str(FIXTURES / "pairs" / "P01.bundle.json"), "plant/in/deep/pair.bundle.json")
    run = lambda **options: outcomes(kinefab.batch(["s3://plant/in"], "s3://plant/out", jobs=1, **options))  # noqa: E731
    assert run() == {"lever.bundle.json": "written", "pair.bundle.json": "written"}
    here = kinefab.export(tmp_path / "lever.bundle.json", tmp_path / "lever.kinefab")
    for path in here.files:
        assert bucket.cat_file(f"plant/out/{path.name}") == path.read_bytes()
    assert bucket.exists("plant/out/deep/pair.kinefab") and bucket.exists("plant/out/index.html")
    assert set(run().values()) == {"up_to_date"}
    bucket.pipe_file("plant/in/lever.obj", bucket.cat_file("plant/in/lever.obj") + b"\n# seen again\n")
    assert run() == {"lever.bundle.json": "written", "pair.bundle.json": "up_to_date"}


def test_what_is_wrong_in_a_bucket_is_told(bucket):
    bucket.pipe_file("plant/in/torn.bundle.json", b"{")
    bucket.pipe_file("plant/out/torn.kinefab", b"mine")
    result = kinefab.batch(["s3://plant/in/*.bundle.json", "s3://plant/gone.urdf"], "s3://plant/out", jobs=1)
    assert outcomes(result) == {"torn.bundle.json": "failed", "gone.urdf": "refused"}
    codes = [code for record in result.records for code in record.codes]
    assert codes == ["BATCH_TARGET_FOREIGN", "SOURCE_NOT_FOUND"]
    assert bucket.cat_file("plant/out/torn.kinefab") == b"mine"


def test_a_bucket_that_is_not_there_is_not_made(bucket):
    bucket.put_file(str(FIXTURES / "pairs" / "P01.bundle.json"), "plant/in/pair.bundle.json")
    with pytest.raises(kinefab.KinefabError, match="TARGET_UNWRITABLE"):
        kinefab.batch(["s3://plant/in"], "s3://nobody-made-this/out", jobs=1)
    assert not bucket.exists("nobody-made-this")
