"""A list that keeps copies of what enters it."""

from __future__ import annotations

import copy
from collections.abc import Iterable
from typing import Any, SupportsIndex, TypeVar, Union

Item = TypeVar("Item")


class OwnedList(list[Item]):
    """A list whose items nobody shares: each is copied when it enters the list.

    Examples
    --------
    >>> corner = [0.0, 1.0]
    >>> corners = OwnedList([corner])
    >>> corners.append(corner)
    >>> corner[0] = 5.0
    >>> corners
    [[0.0, 1.0], [0.0, 1.0]]
    """

    def __init__(self, items: Iterable[Item] = ()) -> None:
        super().__init__(map(copy.deepcopy, items))

    def append(self, item: Item) -> None:
        """Append a copy of an item."""
        super().append(copy.deepcopy(item))

    def insert(self, index: SupportsIndex, item: Item) -> None:
        """Insert a copy of an item before an index."""
        super().insert(index, copy.deepcopy(item))

    def extend(self, items: Iterable[Item]) -> None:
        """Append copies of items."""
        super().extend(OwnedList(items))

    def __iadd__(self, items: Iterable[Item]) -> OwnedList[Item]:  # type: ignore[override,misc]
        self.extend(items)
        return self

    def __imul__(self, count: SupportsIndex) -> OwnedList[Item]:
        self[:] = list(self) * count
        return self

    def __setitem__(self, index: Union[SupportsIndex, slice], given: Any) -> None:
        copied = OwnedList(given) if isinstance(index, slice) else copy.deepcopy(given)
        super().__setitem__(index, copied)  # type: ignore[assignment,index]

    def __deepcopy__(self, memo: dict[int, Any]) -> OwnedList[Item]:
        copied: OwnedList[Item] = OwnedList()
        memo[id(self)] = copied  # first, because a list may contain itself
        list.extend(copied, (copy.deepcopy(item, memo) for item in self))
        return copied
