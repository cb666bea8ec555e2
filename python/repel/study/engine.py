# SPDX-License-Identifier: BSD-3-Clause
"""Makes the runs of a study, by Dask on workers or in this process.

Work goes out in batches of a second and a half by what runs took so far, longer ones where many
workers would otherwise send too many, a few for each worker. Their rows come back in any order.
Workers may come, go and be killed: what they had is made again. What a batch returns is all that is
kept of it, so memory does not grow with the runs.
"""

from __future__ import annotations

import collections
import contextlib
import functools
import importlib.util
import logging
import multiprocessing.resource_tracker
import os
import pickle
import queue
import signal
import statistics
import time
import uuid
import warnings
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, TypeAlias

from .._errors import SetupError, needed
from .files import CannotRun
from .measures import told
from .store import decoded, encoded

if TYPE_CHECKING:
    from .plan import Study

#: A run: its index in the study, or the values and the numbers of the hand.
Job: TypeAlias = "int | tuple[dict[str, float | str], list[float] | None]"

BATCH_S = 1.5  #: [s] that a batch should take, at least
SHORT_S = 0.2  #: [s] of a batch at the end, where what is left is divided evenly, at least
BATCHES_PER_S = 30.0  #: that all workers together should send, at most
IN_FLIGHT = 3  #: batches of each worker: one that runs, and two that wait, so that none idles
DIED = "the worker died"  #: the refusal of a run that killed its worker each time
_PIECES = 8  # into which a batch goes that killed its workers
_POLL_S = 0.5
_CONNECT_S = 5.0

#: Dask keeps logs and profiles for its own pages and looks at itself often; here logs would only
#: grow, and what it sees has no use.
_CONFIG = {
    "distributed.admin.log-length": 100, "distributed.admin.low-level-log-length": 100,
    "distributed.admin.system-monitor.log-length": 100,
    "distributed.admin.system-monitor.interval": "2s", "distributed.admin.tick.interval": "500ms",
    "distributed.diagnostics.computations.max-history": 1,
    "distributed.scheduler.allowed-failures": 2,  # the third death of a worker is the last
    "distributed.scheduler.dashboard.tasks.task-stream-length": 1000,
    "distributed.worker.profile.enabled": False,
}


class Made(NamedTuple):
    """Runs that are done."""

    jobs: Sequence[Job]
    rows: Any  #: pyarrow's Table, a row for each job in the same order


class Engine(Protocol):
    """Where runs are made."""

    def made(self, study: Study, jobs: Sequence[Job]) -> Iterator[Made | None]:
        """Makes the runs and yields their rows as they come; None after half a second without any.
        Raises SetupError if a run fails by a bug, or if what makes them is gone."""
        ...


@contextlib.contextmanager
def engine(workers: int | None, scheduler: str | None,
           say: Callable[[str], None]) -> Iterator[Engine]:
    """Where runs are made: `workers` processes of this machine, None as many as it has processors,
    0 this process itself; or the workers of Dask's scheduler at that address. say: takes what a
    person should know. Raises SetupError if the scheduler does not answer."""
    if workers == 0 and scheduler is None:
        yield Here()
        return
    cluster = Cluster(workers, scheduler, say)
    try:
        yield cluster
    finally:
        cluster.close()


def _row(study: Study, job: Job) -> dict[str, Any]:
    return study.row(job) if isinstance(job, int) else study.row_of(*job)


def name_of(job: Job) -> str:
    """The run as a person calls it."""
    return f"run {job}" if isinstance(job, int) else f"the run of {job[0]}"


def _rows(study: Study, jobs: Sequence[Job]) -> tuple[bytes, str]:
    """The rows, or what was wrong."""
    rows = []
    for job in jobs:
        try:
            rows.append(_row(study, job))
        except CannotRun as error:
            return b"", f"{name_of(job)}: {error}"
        except Exception as error:  # a bug of whatever kind: told where the study is told
            return b"", f"{name_of(job)}: {told(error)}"
    return encoded(rows, study.columns), ""


class Here:
    """Makes runs in this process."""

    def made(self, study: Study, jobs: Sequence[Job]) -> Iterator[Made | None]:
        """As Engine.made."""
        start, size = 0, 1
        while start < len(jobs):
            some = jobs[start:start + size]
            began = time.perf_counter()
            text, trouble = _rows(study, some)
            if trouble:
                raise SetupError(trouble)
            yield Made(some, decoded(text))
            start += size
            per_run = (time.perf_counter() - began) / size
            size = max(1, min(1024, int(_POLL_S / max(per_run, 1e-9))))


# What runs on workers.

@functools.lru_cache(maxsize=2)
def _study_of(pickled: bytes) -> tuple[Any, str]:
    """The study, and what is wrong with this worker for it."""
    study = pickle.loads(pickled)
    here = study.versions_here()
    other = [f"{name} {here.get(name, 'missing')} and not {version}"
             for name, version in study.versions.items() if here.get(name) != version]
    return study, ", ".join(other)


def _trouble_of(pickled: bytes) -> str:
    return _study_of(pickled)[1]


def _make(pickled: bytes, jobs: Sequence[Job]) -> tuple[bytes, float, str]:
    """The encoded rows, the seconds for them, and what was wrong."""
    study, trouble = _study_of(pickled)
    if trouble:
        address = needed("distributed", "dask[distributed]", extra="study").get_worker().address
        return b"", 0.0, _refusal_of(address, trouble)
    began = time.perf_counter()
    text, trouble = _rows(study, jobs)
    return text, time.perf_counter() - began, trouble


def _refusal_of(worker: str, versions: str) -> str:
    return (f"worker {worker} has {versions}; allowed: the same versions on all, as they decide "
            "the bits of the results")


class Cluster:
    """Dask's workers, of this machine or of a scheduler elsewhere."""

    def __init__(self, workers: int | None, scheduler: str | None, say: Callable[[str], None]):
        """As `engine`."""
        self._dask = needed("distributed", "dask[distributed]", extra="study")
        self._say = say
        self._where = scheduler or "this machine"
        self._cluster: Any = None
        self._client: Any = None
        self._threads, self._counted = -1, 0.0  # of all workers, and when
        self._asked = workers or os.cpu_count() or 1  # of this machine
        self._checked = b""
        for name in list(logging.root.manager.loggerDict):
            if name.startswith(("distributed", "tornado")):  # what matters is said by this
                logging.getLogger(name).setLevel(logging.CRITICAL)
        self._config = needed("dask.config", "dask[distributed]", extra="study").set(_CONFIG)
        self._config.__enter__()
        try:
            if scheduler is None:
                self._start()
            else:
                self._connect(scheduler)
        except BaseException:
            self.close()
            raise

    def _start(self) -> None:
        has_pages = importlib.util.find_spec("bokeh") is not None
        # An interrupt from the terminal is this process's to answer. What starts while it is
        # blocked, and workers that are started later from there, do not get it. Python's tracker
        # of resources would unblock it where it starts, so it starts before.
        multiprocessing.resource_tracker.ensure_running()
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # of a port that is taken; it takes another one
                self._cluster = self._dask.LocalCluster(
                    n_workers=self._asked, threads_per_worker=1, processes=True, memory_limit=0,
                    dashboard_address="127.0.0.1:8787" if has_pages else None,
                    silence_logs=logging.CRITICAL)
            self._client = self._dask.Client(self._cluster, set_as_default=False)
        except (OSError, RuntimeError) as error:  # one was killed, as for want of memory
            raise SetupError(f"the workers of this machine do not start: {error}; allowed: fewer "
                             "of them by --workers, or 0 for none") from error
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)
        if has_pages:
            self._say(f"dashboard: {self._cluster.dashboard_link}")

    def _connect(self, address: str) -> None:
        addressing = needed("distributed.comm.addressing", "dask[distributed]", extra="study")
        try:
            addressing.get_address_host_port(address, strict=True)
            self._client = self._dask.Client(address, timeout=_CONNECT_S, set_as_default=False)
        except (OSError, ValueError, TypeError) as error:
            raise SetupError(
                f"--scheduler {address}: {str(error) or 'no answer'}; allowed: the address of a "
                "running scheduler of Dask, as tcp://HOST:8786") from error
        if importlib.util.find_spec("bokeh") is not None and self._client.dashboard_link:
            self._say(f"dashboard: {self._client.dashboard_link}")

    def close(self) -> None:
        """Ends the workers of this machine; leaves a scheduler elsewhere as it is."""
        for each, how in ((self._client, {"timeout": 2}), (self._cluster, {"timeout": 10})):
            if each is not None:
                with contextlib.suppress(Exception):  # of what is gone already
                    each.close(**how)
        self._config.__exit__(None, None, None)

    def _workers(self) -> int:
        """Threads of all workers, counted once a second; says when there are none, and starts
        those of this machine that are missing. Raises SetupError if the scheduler is gone."""
        if self._client.status == "running":
            if time.monotonic() - self._counted > 1.0:
                with contextlib.suppress(OSError):
                    before, self._threads = self._threads, sum(self._client.nthreads().values())
                    self._counted = time.monotonic()
                    if self._threads == 0 and before != 0:
                        self._say(f"{self._where} has no worker; waiting for one")
                    if self._cluster is not None and self._threads < self._asked:
                        self._restart()
            if self._client.status == "running":
                return max(self._threads, 0)
        raise SetupError(f"the scheduler of {self._where} is gone; allowed: the "
                         "address of a running one, or --workers; a study goes on with --resume, "
                         "nothing is lost")

    def _restart(self) -> None:
        """Dask gives up a worker that is away at the wrong moment, or is killed as it starts."""
        for name, keeper in list(self._cluster.workers.items()):
            if keeper.status.name in ("closed", "failed"):
                self._cluster.workers.pop(name, None)
        self._cluster.scale(self._asked)

    def made(self, study: Study, jobs: Sequence[Job]) -> Iterator[Made | None]:
        """As Engine.made. Waits for workers if there are none."""
        pickled = pickle.dumps(study)
        yield from self._first_worker()
        if pickled != self._checked:  # workers that come later check it before their first run
            self._check(pickled)
            self._checked = pickled
        done: queue.SimpleQueue[Any] = queue.SimpleQueue()
        flying: dict[str, tuple[Any, Sequence[Job]]] = {}
        suspects: list[Sequence[Job]] = []  # killed their workers, or were beside what did
        start = 0
        recent = collections.deque([BATCH_S], 15)  # [s] of a run, in batches of late

        def send(batch: Sequence[Job]) -> None:
            future = self._client.submit(_make, pickled, batch, pure=False,
                                         key=f"repel-study-{uuid.uuid4().hex}")
            flying[future.key] = future, batch
            future.add_done_callback(done.put)

        while True:
            workers = self._workers()
            while start < len(jobs) and len(flying) < IN_FLIGHT * workers:
                run_s = statistics.median(recent)
                even = -(-(len(jobs) - start) // (IN_FLIGHT * workers))  # so that all end together
                most = int(max(BATCH_S, workers / BATCHES_PER_S) / run_s)
                some = jobs[start:start + max(1, min(most, max(even, int(SHORT_S / run_s))))]
                send(some)
                start += len(some)
            if start == len(jobs) and not flying:
                if not suspects:
                    return
                send(suspects.pop())  # alone, so that nothing else is blamed for it
            try:
                future = done.get(timeout=_POLL_S)
            except queue.Empty:
                yield None
                continue
            batch = flying[future.key][1]
            try:
                text, seconds, trouble = future.result(timeout=_CONNECT_S)
            except self._dask.KilledWorker:
                del flying[future.key]
                is_alone = start == len(jobs) and not flying
                if is_alone and len(batch) == 1:
                    self._say(f"{name_of(batch[0])}: {DIED} each time; it counts as refused")
                    yield Made(batch, decoded(encoded([_dead(study, batch[0])], study.columns)))
                else:
                    size = -(-len(batch) // _PIECES)
                    suspects += [batch[i:i + size] for i in range(0, len(batch), size)]
                continue
            except (TimeoutError, self._dask.TimeoutError):
                done.put(future)  # its worker went away with it; it is made again
                continue
            except (self._dask.CancelledError, OSError):
                del flying[future.key]
                self._workers()
                send(batch)
                continue
            except Exception as error:  # of Dask or of the import of the study
                raise SetupError(f"a worker of {self._where} cannot run the study: "
                                 f"{type(error).__name__}: {error}") from error
            del flying[future.key]
            future.release()
            if trouble:
                raise SetupError(trouble)
            recent.append(max(seconds / len(batch), 1e-6))
            yield Made(batch, decoded(text))

    def _first_worker(self) -> Iterator[None]:
        while self._workers() == 0:
            time.sleep(_POLL_S)
            yield None

    def _check(self, pickled: bytes) -> None:
        """Raises SetupError if a worker cannot have the study, or has other versions."""
        for worker, trouble in self._client.run(_trouble_of, pickled, on_error="return").items():
            if isinstance(trouble, OSError):
                continue  # it has just gone
            if isinstance(trouble, Exception):
                raise SetupError(f"worker {worker} cannot run the study: {type(trouble).__name__}: "
                                 f"{trouble}; allowed: workers with this package and all that the "
                                 "study reads")
            if trouble:
                raise SetupError(_refusal_of(worker, trouble))


def _dead(study: Study, job: Job) -> dict[str, Any]:
    """The row of a run that killed its worker each time."""
    empty = {"int64": -1, "float64": float("nan"), "string": "", "bool": False}
    row = {name: empty[kind] for name, kind in study.columns}
    values = study.values(job) if isinstance(job, int) else job[0]
    index = job if isinstance(job, int) else -1
    return {**row, **values, "index": index, "refused": DIED, "held": False}
