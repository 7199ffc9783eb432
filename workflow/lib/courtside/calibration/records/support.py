"""How much of the verified matches a map explains."""

from typing import NamedTuple


class Support(NamedTuple):
    """How much of the verified matches of some images a map explains."""

    share: float  # of all, 0..1; 1 without any
    image: str  # whose matches are explained least
    image_share: float
    pair: tuple[str, str]  # of the pairs with many matches the one explained least; empty: no pair
    pair_share: float  # 1 without any
