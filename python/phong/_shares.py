"""Into which shares a picture is cut: large ones first, and small ones towards its end."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import Final

#: A share is at most what is left, over so many times the threads there are. Half of that would be
#: enough where all threads are equally fast; a thread that is slower than the others should not be
#: at its first share when they are at their last.
_CAUTION: Final = 4
#: Seconds that a share takes at least, so that what each costs beside its rays stays small.
_SECONDS: Final = 0.2
#: For how many threads the first shares are cut where no worker is there yet.
_UNKNOWN: Final = 32


@dataclass(frozen=True, order=True)
class Share:
    """Every ``count``-th tile of a picture, from tile ``index`` on."""

    index: int
    count: int

    @property
    def size(self) -> float:
        """How much of the picture it is."""
        return 1 / self.count

    def holds(self, other: Share) -> bool:
        """Whether all tiles of another share are in this one."""
        return other.count % self.count == 0 and other.index % self.count == self.index

    def halves(self) -> tuple[Share, Share]:
        """The two shares that it is made of."""
        return (
            Share(self.index, 2 * self.count),
            Share(self.index + self.count, 2 * self.count),
        )


class Equal:
    """So many shares of one size."""

    def __init__(self, count: int, done: Collection[Share]) -> None:
        self.finest = count
        self._left = (Share(i, count) for i in range(count) if Share(i, count) not in done)

    def next(self, threads: int) -> Share | None:
        """The next share to be rendered; None after the last."""
        del threads
        return next(self._left, None)

    def took(self, share: Share, seconds: float) -> None:
        """A share was rendered in so many seconds."""


class Falling:
    """Shares that get smaller the less is left, so that all workers end at nearly the same time.

    Their counts are powers of two: a share's two halves are shares again, and whatever is done of
    a picture, what is left of it can be cut in the same way.
    """

    def __init__(self, tiles: int, done: Collection[Share]) -> None:
        #: The count of the smallest shares: those have a tile or two.
        self.finest = 1 << (max(1, tiles).bit_length() - 1)
        self._left = sorted(self._without(Share(0, 1), done))
        self._speed = 0.0

    def _without(self, share: Share, done: Collection[Share]) -> Iterator[Share]:
        """The largest shares within one of which nothing is done."""
        if share in done:
            return
        if not any(share.holds(other) for other in done):
            yield share
            return
        for half in share.halves():
            yield from self._without(half, done)

    def next(self, threads: int) -> Share | None:
        """The next share to be rendered, for so many threads; None after the last."""
        if not self._left:
            return None
        left = sum(share.size for share in self._left)
        wanted = max(left / (_CAUTION * (threads or _UNKNOWN)), self._speed * _SECONDS)
        share = max(self._left, key=lambda share: (share.size, -share.index))
        self._left.remove(share)
        while share.size > wanted and 2 * share.count <= self.finest:
            share, other = share.halves()
            self._left.append(other)
        return share

    def took(self, share: Share, seconds: float) -> None:
        """A share was rendered in so many seconds."""
        if seconds > 0:
            self._speed = share.size / seconds


def fitting(
    tiles: int, shares: int | None, stored: Collection[Share]
) -> tuple[int | None, list[Share]]:
    """How a picture of so many tiles is cut, and which of the stored shares fit into that.

    ``shares``: so many of one size; None is whatever most of the picture is stored in. Returns the
    count of equal shares, or None for such of falling sizes.
    """
    if shares is None:
        finest = Falling(tiles, ()).finest
        falling = [s for s in stored if s.count.bit_count() == 1 and s.count <= finest]
        falling = [s for s in falling if not any(o != s and o.holds(s) for o in falling)]
        done = Counter(share.count for share in stored)
        shares = max(done, key=lambda count: (done[count] / count, count), default=1)
        if sum(share.size for share in falling) >= done[shares] / shares:
            return None, falling
    return shares, [share for share in stored if share.count == shares]
