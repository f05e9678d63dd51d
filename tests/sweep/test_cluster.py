"""A sweep on a real dask scheduler with two worker processes."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from click.testing import CliRunner
from deadly import Deadly, Slow
from made_parts import bumpy_sheet

import geomdrap as gd
from geomdrap.cli import cli
from geomdrap.sweep import Job, Row, cases_of, run
from geomdrap.sweep.cluster import ClusterPool

distributed = pytest.importorskip("distributed")
HERE = Path(__file__).parent
CASES = cases_of(["centroid", (10.0, -20.0, 0.0)], [float(a) for a in range(0, 90, 5)])


class Cluster:
    """A scheduler and workers, each a process of its own."""

    def __init__(self, folder: Path):
        self.folder = folder
        self.processes: list[subprocess.Popen[bytes]] = []
        self.begin(
            "dask_scheduler", "--port", "0", "--host", "127.0.0.1", "--scheduler-file", str(folder / "at.json")
        )
        self.address = self._address()

    def begin(self, what: str, *asked: str) -> subprocess.Popen[bytes]:
        """Start a process; it finds the effects of the tests."""
        path = os.pathsep.join([str(HERE), str(Path(gd.__file__).parents[1]), os.environ.get("PYTHONPATH", "")])
        command = [sys.executable, "-m", f"distributed.cli.{what}", *asked, "--no-dashboard"]
        with (self.folder / f"{what}-{len(self.processes)}.log").open("wb") as log:
            process = subprocess.Popen(command, stdout=log, stderr=log, env={**os.environ, "PYTHONPATH": path})
        self.processes.append(process)
        return process

    def worker(self) -> subprocess.Popen[bytes]:
        """Start a worker without anybody who would start it again."""
        where = str(self.folder / f"worker-{len(self.processes)}")
        return self.begin("dask_worker", self.address, "--nthreads", "1", "--no-nanny", "--local-directory", where)

    def wait_for_workers(self, count: int) -> None:
        """Wait until so many are there, however busy the machine is."""
        with distributed.Client(self.address, timeout=60, set_as_default=False) as client:
            client.wait_for_workers(count, timeout=60)

    def _address(self) -> str:
        file = self.folder / "at.json"
        for _ in range(600):
            if file.exists() and file.read_text().strip().endswith("}"):
                return str(json.loads(file.read_text())["address"])
            time.sleep(0.05)
        raise TimeoutError("the scheduler did not start")

    def close(self) -> None:
        """End all processes."""
        for process in self.processes:
            process.kill()
            process.wait()


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[Cluster]:
    cluster = Cluster(tmp_path)
    try:
        yield cluster
    finally:
        cluster.close()


def _keys(rows: list[Row]) -> list[tuple[object, float]]:
    return sorted(((row.asked, row.angle) for row in rows), key=str)


def test_a_worker_killed_in_mid_sweep_loses_no_row_and_repeats_none(cluster: Cluster, tmp_path: Path) -> None:
    workers = [cluster.worker(), cluster.worker()]
    diary = tmp_path / "diary"
    job = Job(bumpy_sheet(), pitch=8.0, effects=(Slow(diary, 0.1),))
    seen: list[Row] = []

    def on_row(row: Row) -> None:
        seen.append(row)
        if len(seen) > 5 and who() == {worker.pid for worker in workers}:  # both take part
            workers[0].send_signal(signal.SIGKILL)

    def who() -> set[int]:
        return {int(line.split()[0]) for line in diary.read_text().splitlines()}

    pool = ClusterPool(job, cluster.address)
    pool.client.wait_for_workers(2, timeout=60)
    rows = run(job, CASES, pool=pool, on_row=on_row).rows
    assert workers[0].wait(10) == -signal.SIGKILL
    assert who() == {worker.pid for worker in workers}
    assert _keys(seen) == _keys(list(rows)) == sorted(((c.origin, c.angle) for c in CASES), key=str)
    here = run(Job(job.surface, pitch=8.0), CASES).rows
    assert rows == here  # to the last bit


@pytest.mark.slow
def test_a_case_that_kills_every_worker_is_a_row_with_the_reason(cluster: Cluster, tmp_path: Path) -> None:
    for _ in range(2):
        where = ("--local-directory", str(tmp_path / f"nanny-{len(cluster.processes)}"))
        cluster.begin("dask_worker", cluster.address, "--nthreads", "1", *where)
    cluster.wait_for_workers(2)
    job = Job(bumpy_sheet(), pitch=8.0, effects=(Deadly(os.getpid()),))
    rows = run(job, CASES[:9], pool=ClusterPool(job, cluster.address)).rows
    assert [row.angle for row in rows if row.reason is not None] == [30.0]


def test_the_command_drapes_on_the_scheduler_with_effects_of_the_users_own(
    cluster: Cluster, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cluster.worker()
    cluster.wait_for_workers(1)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.py").write_text(
        "import geomdrap as gd\nclass Mine(gd.Effect):\n    name = 'mine'\n    def on_fabric(self, fabric):\n"
        "        from dataclasses import replace\n        return replace(fabric, weft_angle=80.0)\n"
    )

    def sweep(*place: str) -> dict[str, object]:
        asked = ["saddle.stl", "--angles", "0,30", "--plugin", "mine.py", "--effect", "mine", "--outputs", "none"]
        result = CliRunner().invoke(cli, ["sweep", *asked, "--json", *place], catch_exceptions=False)
        assert result.exit_code == 0, result.output
        document: dict[str, object] = json.loads(result.stdout)
        return document

    CliRunner().invoke(cli, ["sample", "saddle", "--facets", "1500"], catch_exceptions=False)
    assert sweep("--scheduler", cluster.address) == sweep("-j", "1")


def test_a_scheduler_that_does_not_answer_is_an_error_within_ten_seconds() -> None:
    with socket.socket() as deaf:  # takes connections and says nothing
        deaf.bind(("127.0.0.1", 0))
        deaf.listen()
        start = time.monotonic()
        with pytest.raises(gd.SweepError, match=r"no dask scheduler answers at 'tcp://127\.0\.0\.1:\d+' within 4 s"):
            ClusterPool(Job(bumpy_sheet()), f"tcp://127.0.0.1:{deaf.getsockname()[1]}")
        assert time.monotonic() - start < 10.0


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "nonsense", "smoke://here:1", ""])
def test_an_address_where_no_scheduler_can_be_is_an_error(address: str) -> None:
    with pytest.raises(gd.SweepError, match="no dask scheduler answers at"):
        ClusterPool(Job(bumpy_sheet()), address)


def test_a_scheduler_without_workers_is_an_error(cluster: Cluster) -> None:
    with pytest.raises(gd.SweepError, match="has no workers; start one: dask worker tcp://"):
        ClusterPool(Job(bumpy_sheet()), cluster.address)
