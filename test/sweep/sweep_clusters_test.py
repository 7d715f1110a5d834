"""Clusters give the table that local processes give. Slurm and Dask are used where they are; a queue of scripts stands in for Slurm otherwise."""
import os
import shutil
import subprocess
import sys

import pytest

from sweep_case import ROOT, column, wait_until

sys.path.insert(0, str(ROOT / "scripts" / "sweep"))
from sweeping import slurm_jobs  # noqa: E402

# A queue that runs its tasks at once or, with HOLD, never: sbatch, squeue, scancel and scontrol as far as their manuals say what is asked of them.
QUEUE = {
    "sbatch": """#!/bin/bash
for word in "$@"; do case "$word" in
  --array=0-*) last="${word#--array=0-}";; --wrap=*) script="${word#--wrap=}";; --partition=none) echo "sbatch: error: no such partition" >&2; exit 1;;
esac; done
cd "$QUEUE" && echo job >>jobs && job="$(wc -l <jobs)"
for ((k = 0; k <= last; ++k)); do
  if [ -e hold ]; then echo "${job}_$k" >>queued
  else SLURM_ARRAY_TASK_ID="$k" setsid sh -c "$script" >/dev/null 2>&1 & fi
done
echo "$job"
""",
    "squeue": '#!/bin/sh\ntouch "$QUEUE/looked_for_$PPID"\n[ ! -e "$QUEUE/queued" ] || cat "$QUEUE/queued"\n',
    "scancel": '#!/bin/sh\necho "$@" >>"$QUEUE/cancelled"\n',
    "scontrol": '#!/bin/sh\necho "JobId=1 JobState=OUT_OF_MEMORY Reason=OutOfMemory"\n',
}


@pytest.fixture
def queue(case):
    """Folder of the queue that stands in for Slurm."""
    folder = case.folder / "queue"
    folder.mkdir()
    for name, text in QUEUE.items():
        (folder / name).write_text(text)
        (folder / name).chmod(0o755)
    case.environment.update(PATH="%s:%s" % (folder, os.environ["PATH"]), QUEUE=str(folder))
    return folder


def same_as_local(case, *options):
    case.write_sweep(parameters={"contact.friction": [0.1, -1, 0.3]})
    local = case.run(status=1)
    shutil.rmtree(str(case.out))
    assert case.run(*options, status=1) == local
    assert column(local, "status") == ["done", "refused", "done"]


def test_slurm_gives_the_same_table(case):
    if not shutil.which("sbatch") or subprocess.run(["sinfo"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode:
        pytest.skip("no Slurm answers here (slurm-wlm)")
    same_as_local(case, "--on", "slurm")


def test_a_queue_gives_the_same_table(case, queue):
    same_as_local(case, "--on", "slurm", "--slurm-options=--mem=1G")


def test_jobs_of_a_killed_sweep_are_taken_over(case, queue):
    case.write_sweep()
    (queue / "hold").touch()
    killed = subprocess.Popen(case.command("--on", "slurm"), env=case.environment, stderr=subprocess.DEVNULL)
    wait_until(lambda: (queue / "queued").exists() and len(case.query("SELECT job FROM runs WHERE job IS NOT NULL")) == 3)
    killed.kill()
    killed.wait()
    second = subprocess.Popen(case.command("--on", "slurm"), env=case.environment, stdout=subprocess.DEVNULL)
    wait_until((queue / ("looked_for_%d" % second.pid)).exists)
    assert second.poll() is None
    second.terminate()
    assert second.wait(20) == 1
    assert (queue / "jobs").read_text() == "job\n", "nothing was submitted twice"
    assert (queue / "cancelled").read_text() == "1\n"
    for name in ("hold", "queued"):
        (queue / name).unlink()
    assert column(case.run("--on", "slurm"), "status") == ["done"] * 3


def test_jobs_that_leave_no_outcome(case, queue, monkeypatch):
    monkeypatch.setenv("PATH", case.environment["PATH"])
    monkeypatch.setenv("QUEUE", str(queue))
    monkeypatch.setattr(slurm_jobs, "PATIENCE", 0.0)
    monkeypatch.setattr(slurm_jobs, "LOOK_PERIOD", 0.0)
    (queue / "hold").touch()
    jobs = slurm_jobs.SlurmJobs(case.folder, [])
    assert jobs.start({"a": case.folder / "a", "b": case.folder / "b"}) == {"a": "1_0", "b": "1_1"}
    assert jobs.ended() == [] and jobs.ended() == []
    (queue / "queued").write_text("1_0\n")
    assert jobs.ended() == []
    outcome, = jobs.ended()
    assert (outcome["key"], outcome["status"]) == ("b", "died")
    assert outcome["message"].startswith("Slurm's job 1_1 left no outcome: OUT_OF_MEMORY OutOfMemory")


def test_slurm_that_is_missing_or_refuses(case, queue):
    case.write_sweep()
    assert "no such partition" in case.refusal("--on", "slurm", "--slurm-options=--partition=none")
    case.environment["PATH"] = str(case.folder)
    assert "sbatch is not on PATH" in case.refusal("--on", "slurm")


def test_dask_gives_the_same_table(case):
    distributed = pytest.importorskip("distributed", reason="python3-distributed is not installed")
    with distributed.LocalCluster(n_workers=1, threads_per_worker=2, processes=False, protocol="tcp", dashboard_address=None) as cluster:
        same_as_local(case, "--on", "dask:" + cluster.scheduler_address)


def test_dask_that_is_missing_or_does_not_answer(case):
    case.write_sweep()
    pytest.importorskip("distributed", reason="python3-distributed is not installed")
    for address in ("tcp://127.0.0.1:9", "127.0.0.1:99999", "nowhere", "no.such.host.invalid:8786"):
        assert "--on dask:" + address in case.refusal("--on", "dask:" + address)
    (case.folder / "distributed.py").write_text("raise ImportError\n")
    case.environment["PYTHONPATH"] = str(case.folder)
    assert "python3-distributed is not installed" in case.refusal("--on", "dask:tcp://127.0.0.1:9")
