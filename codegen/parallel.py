"""Run independent jobs on all cores; results come back in the order of the jobs, whatever order they finish in."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from typing import TypeVar

Job = TypeVar("Job")
Result = TypeVar("Result")


def parallel(work: Callable[[Job], Result], jobs: Sequence[Job], done: Callable[[Job], None]) -> list[Result]:
    """Apply ``work`` to every job.

    Args:
        work: a function that can be sent to another process.
        jobs: its arguments.
        done: told each job as it is finished.
    """
    cores = min(len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1, len(jobs))
    if cores < 2:
        return [_told(work(job), job, done) for job in jobs]
    with ProcessPoolExecutor(cores) as pool:
        try:
            futures = {pool.submit(work, job): position for position, job in enumerate(jobs)}
            results: dict[int, Result] = {}
            for future in as_completed(futures):
                results[futures[future]] = _told(future.result(), jobs[futures[future]], done)
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
    return [results[position] for position in range(len(jobs))]


def _told(result: Result, job: Job, done: Callable[[Job], None]) -> Result:
    done(job)
    return result
