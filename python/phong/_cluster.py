"""Tasks on a Dask cluster: under way, done, lost, and never waited for in vain."""

from __future__ import annotations

import queue
import time
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic, TypeVar

if TYPE_CHECKING:
    from distributed import Future

Name = TypeVar("Name")

#: Seconds after which the cluster is looked at, where nothing was heard of it.
_LOOK = 1.0
#: How often a task is tried anew after its workers died, where others were done meanwhile.
_RETRIES = 2


class ClusterError(RuntimeError):
    """The cluster cannot do a task; the message says which, and why."""


@dataclass(frozen=True)
class Task(Generic[Name]):
    """Something to be done by a worker."""

    name: Name
    #: What messages call it.
    title: str
    #: Gives it to the scheduler, under a new key each time.
    submit: Callable[[], Future[Any]]


@dataclass
class _Submitted(Generic[Name]):
    """A task that the scheduler knows."""

    task: Task[Name]
    future: Future[Any]
    tried: int
    #: How many tasks were done when it was submitted.
    done_before: int


def run_tasks(
    client: Any, tasks: Iterator[Task[Name]], *, timeout: float | None
) -> Iterator[tuple[Name, bytes]]:
    """What comes of each task, as it comes.

    At most two tasks a thread of the cluster are submitted at once, so that a worker that dies
    takes few with it and the scheduler holds few arguments. Leaving the iterator, by Ctrl-C too,
    cancels what is under way.

    Raises ClusterError, or what the task raised.
    """
    heard: queue.SimpleQueue[Future[Any]] = queue.SimpleQueue()
    under_way: dict[object, _Submitted[Name]] = {}
    watch = _Watch(client, timeout)
    done = 0

    def submit(task: Task[Name], tried: int) -> None:
        future = task.submit()
        under_way[future.key] = _Submitted(task, future, tried, done)
        future.add_done_callback(heard.put)

    try:
        while True:
            while len(under_way) < watch.at_once and (task := next(tasks, None)) is not None:
                submit(task, 0)
            if not under_way:
                return
            try:
                future = heard.get(timeout=_LOOK)
            except queue.Empty:
                watch.look()
                continue
            known = under_way.pop(future.key)
            result = _result(known, done, timeout)
            if result is None:
                submit(known.task, known.tried + 1)
                continue
            done += 1
            watch.heard()
            # The worker may forget it.
            future.release()
            yield known.task.name, result
    finally:
        left = [known.future for known in under_way.values()]
        if left and client.status == "running":
            client.cancel(left, force=True)


def _result(known: _Submitted[Name], done: int, timeout: float | None) -> bytes | None:
    """What a finished task gave; None where it is worth another try."""
    from distributed import KilledWorker

    title = known.task.title
    try:
        result: bytes = known.future.result(timeout=timeout)
    except KilledWorker as error:
        # Dask counts the deaths that a task met for as long as it knows it, and scenes are kept for
        # many pictures: one that was unlucky too often is sent anew.
        is_scene = str(error.task) != str(known.future.key)
        if known.tried < _RETRIES and (done > known.done_before or (is_scene and not known.tried)):
            return None
        limit = getattr(error.last_worker, "memory_limit", 0)
        memory = f", which may use {limit / 1e6:.0f} MB of memory" if limit else ""
        raise ClusterError(
            f"{title}: {error.allowed_failures + 1} workers died while it was on them, the last "
            f"{error.last_worker.address}{memory}. Workers that use more memory than they may are "
            "killed: give them more, or make more shares of smaller pictures; their logs say more"
        ) from error
    except CancelledError as error:
        raise ClusterError(
            f"{title}: the scheduler is gone, or has forgotten it ({error}); with store=FOLDER "
            "another call goes on from the shares that are done"
        ) from error
    except TimeoutError as error:
        raise ClusterError(f"{title}: its result did not come within {timeout} s") from error
    return result


class _Watch:
    """Looks at the cluster where nothing is heard of it, and says when there is no hope."""

    def __init__(self, client: Any, timeout: float | None) -> None:
        self.client = client
        self.timeout = timeout
        #: How many tasks are submitted at once.
        self.at_once = 2
        self._since = time.monotonic()
        self._looked = 0.0
        self._count(self._workers())

    def heard(self) -> None:
        """A task was done."""
        self._since = time.monotonic()
        if self._since - self._looked > 5 * _LOOK:
            self._count(self._workers())

    def look(self) -> None:
        """Raises ClusterError where nobody could work for too long."""
        if self.client.status != "running":
            if self.client.status in ("closed", "closing"):
                raise ClusterError("the client was closed")
        else:
            workers = self._workers()
            self._count(workers)
            trouble = self._trouble(workers)
            if trouble is None:
                self._since = time.monotonic()
                return
            self._hopeless(trouble)
            return
        self._hopeless("the scheduler does not answer")

    def _hopeless(self, trouble: str) -> None:
        if self.timeout is not None and time.monotonic() - self._since > self.timeout:
            raise ClusterError(f"nothing was done for {self.timeout:g} s: {trouble}")

    def _workers(self) -> dict[str, dict[str, object]]:
        try:
            info = self.client.scheduler_info()
        except (OSError, TimeoutError):
            return {}
        workers: dict[str, dict[str, object]] = dict(info["workers"])
        self._looked = time.monotonic()
        return workers

    def _count(self, workers: dict[str, dict[str, object]]) -> None:
        threads = sum(int(str(worker["nthreads"])) for worker in workers.values())
        self.at_once = max(2, 2 * threads)

    def _trouble(self, workers: dict[str, dict[str, object]]) -> str | None:
        """Why nobody works, or None where somebody does."""
        if not workers:
            return "the cluster has no worker"
        states = {str(worker["status"]) for worker in workers.values()}
        if states == {"paused"}:
            limits = [float(str(worker["memory_limit"])) / 1e6 for worker in workers.values()]
            return (
                "all workers are paused, for they use nearly all the memory that they may "
                f"({min(limits):.0f} MB or more each)"
            )
        if "running" not in states:
            return f"no worker is running (they are {', '.join(sorted(states))})"
        try:
            if any(self.client.processing().values()):
                return None
        except (OSError, TimeoutError):
            return "the scheduler does not answer"
        return "no worker takes the tasks: none offers the resources that they ask for"
