#!/usr/bin/env python3
# row: 24
# input: three tasks of srun without its PMI
# right: a sentence that says what to do, from each task, and no table; one task works
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "lib"))
from programs import *  # noqa: E402,F403

import os

with Folder() as folder:
    for more in ({"SLURM_STEP_NUM_TASKS": "3"}, {"SLURM_STEPID": "1"}):
        for task in ("0", "2"):
            clean = {k: v for k, v in os.environ.items() if not k.startswith(("SLURM", "OMPI", "PMI"))}
            done = run(
                "sparkbatch",
                "--config",
                "world.lua",
                "--runs",
                "2",
                "--duration",
                "0.2",
                "--results",
                "t.csv",
                cwd=folder,
                env={
                    **clean,
                    "SLURM_JOB_ID": "7",
                    "SLURM_STEP_ID": "0",
                    "SLURM_NTASKS": "3",
                    "SLURM_PROCID": task,
                    **more,
                },
            )
            judge(
                f"task {task} says what to do",
                done.returncode == 2 and "--mpi=pmix" in done.stderr,
                f"{done.returncode} {done.stderr}",
            )
    judge("there is no table", not (folder / "t.csv").exists())
    done = run("sparkbatch", "--config", "world.lua", "--duration", "0.2", "--results", "t.csv", cwd=folder,
               env={**clean, "SLURM_JOB_ID": "7", "SLURM_NTASKS": "3", "SLURM_PROCID": "0"})
    judge("a job's script, which is no task of srun, works", done.returncode == 0, done.stderr)
