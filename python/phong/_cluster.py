"""Tasks on a Dask cluster: under way, done, lost, and never waited for in vain."""

from __future__ import annotations

import queue
import time
from collections import Counter
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic, TypeVar

if TYPE_CHECKING:
    from distributed import Future

Name = TypeVar("Name")
Result = TypeVar("Result")

#: Seconds after which the cluster is looked at, where nothing was heard of it.
_LOOK = 1.0
#: How often a task is tried anew after its workers died, where others were done meanwhile.
_RETRIES = 2


class ClusterError(RuntimeError):
    """The cluster cannot do a task; the message says which, and why."""


@dataclass(frozen=True)
class Task(Generic[Name, Result]):
    """Something to be done by a worker."""

    name: Name
    #: What messages call it.
    title: str
    #: Gives it to the scheduler, under a new key each time, with these keywords of ``submit``.
    submit: Callable[..., Future[Result]]


@dataclass
class _Submitted(Generic[Name, Result]):
    """A task that the scheduler knows."""

    task: Task[Name, Result]
    future: Future[Result]
    #: The worker that it was meant for; empty where Dask chose.
    worker: str
    tried: int
    #: How many tasks were done when it was submitted.
    done_before: int


def run_tasks(
    client: Any,
    next_task: Callable[[int], Task[Name, Result] | None],
    *,
    timeout: float | None,
) -> Iterator[tuple[Name, Result]]:
    """What comes of each task, as it comes.

    ``next_task`` is asked for the next task, and told how many threads the cluster has now; None is
    the end. At most two tasks a thread of the cluster are submitted at once, so that a worker that
    dies takes few with it, the scheduler holds few arguments, and a worker that is done has the
    next task at hand. Leaving the iterator, by Ctrl-C too, cancels what is under way.

    Raises ClusterError, or what the task raised.
    """
    heard: queue.SimpleQueue[Future[Result]] = queue.SimpleQueue()
    under_way: dict[object, _Submitted[Name, Result]] = {}
    watch = _Watch(client, timeout)
    done = 0

    def submit(task: Task[Name, Result], tried: int, worker: str = "") -> None:
        where = {"workers": [worker], "allow_other_workers": True} if worker else {}
        future = task.submit(**where)
        under_way[future.key] = _Submitted(task, future, worker, tried, done)
        future.add_done_callback(heard.put)

    def first_worker() -> str:
        """For whom a task is, as long as no worker has done one.

        Dask would give them all to the one that has the scene, and think better of it most of a
        second later.
        """
        return watch.idlest(Counter(one.worker for one in under_way.values())) if not done else ""

    try:
        while True:
            while len(under_way) < watch.at_once and (task := next_task(watch.threads)) is not None:
                submit(task, 0, first_worker())
            if not under_way:
                return
            try:
                future = heard.get(timeout=_LOOK)
            except queue.Empty:
                if not watch.look():
                    # A task that was meant for a worker which died as the last one waits for ever.
                    for known in [one for one in under_way.values() if one.worker]:
                        del under_way[known.future.key]
                        client.cancel([known.future], force=True)
                        submit(known.task, known.tried)
                continue
            if future.key not in under_way:
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


def _result(known: _Submitted[Name, Result], done: int, timeout: float | None) -> Result | None:
    """What a finished task gave; None where it is worth another try."""
    from distributed import KilledWorker

    title = known.task.title
    try:
        result = known.future.result(timeout=timeout)
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
        #: Threads of the workers that can take tasks.
        self._threads_of: dict[str, int] = {}
        self._since = time.monotonic()
        self._looked = 0.0
        self._count(self._workers())

    @property
    def threads(self) -> int:
        """How many threads the cluster has."""
        return sum(self._threads_of.values())

    @property
    def at_once(self) -> int:
        """How many tasks are submitted at once."""
        return max(2, 2 * self.threads)

    def idlest(self, tasks: Counter[str]) -> str:
        """The worker with the fewest tasks a thread; empty where Dask is to choose.

        It is, where the caller has said what workers are wanted (``dask.annotate``).
        """
        from dask.base import get_annotations

        if not self._threads_of or get_annotations():
            return ""
        return min(self._threads_of, key=lambda one: tasks[one] / self._threads_of[one])

    def heard(self) -> None:
        """A task was done."""
        self._since = time.monotonic()
        if self._since - self._looked > 5 * _LOOK:
            self._count(self._workers())

    def look(self) -> bool:
        """Whether the workers that are there do something; raises ClusterError where nobody could
        work for too long."""
        trouble: str | None = "the scheduler does not answer"
        running = False
        if self.client.status == "running":
            workers = self._workers()
            self._count(workers)
            running = bool(self._threads_of)
            trouble = self._trouble(workers)
        elif self.client.status in ("closed", "closing"):
            raise ClusterError("the client was closed")
        if trouble is None:
            self._since = time.monotonic()
        elif self.timeout is not None and time.monotonic() - self._since > self.timeout:
            raise ClusterError(f"nothing was done for {self.timeout:g} s: {trouble}")
        return trouble is None or not running

    def _workers(self) -> dict[str, dict[str, object]]:
        try:
            # Some versions of Dask tell of five workers unless all are asked for.
            info = self.client.scheduler_info(n_workers=-1)
        except (OSError, TimeoutError):
            return {}
        workers: dict[str, dict[str, object]] = dict(info["workers"])
        self._looked = time.monotonic()
        return workers

    def _count(self, workers: dict[str, dict[str, object]]) -> None:
        self._threads_of = {
            address: int(str(worker["nthreads"]))
            for address, worker in workers.items()
            if worker["status"] == "running"
        }

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
