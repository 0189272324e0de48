"""Run independent jobs on all cores; results come back in the order of the jobs, whatever order they finish in."""

from __future__ import annotations

import contextlib
import os
import signal
from collections.abc import Callable, Iterator, Sequence
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
    with ProcessPoolExecutor(cores, initializer=_ignore_interrupts) as pool:
        try:
            with _interrupts_held():
                futures = {pool.submit(work, job): position for position, job in enumerate(jobs)}
            results: dict[int, Result] = {}
            for future in as_completed(futures):
                results[futures[future]] = _told(future.result(), jobs[futures[future]], done)
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
    return [results[position] for position in range(len(jobs))]


def _ignore_interrupts() -> None:
    """An interrupt from the terminal reaches every process; only the first one answers it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextlib.contextmanager
def _interrupts_held() -> Iterator[None]:
    """Keep an interrupt back while processes are forked, where it would be lost."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _told(result: Result, job: Job, done: Callable[[Job], None]) -> Result:
    done(job)
    return result
