"""Workers in one process or several give the same results in order; random streams differ."""

import numpy as np
import pytest

from fixtures.study.workers import Worker
from virtualgym.session import parallel


@pytest.mark.parametrize("threads", [1, 2])
def test_results_come_in_the_order_of_the_calls(threads):
    with parallel.workers(Worker, (100,), threads) as call:
        assert list(call("add", [(3,), (1,), (2, 10)])) == [103, 101, 112]
        with pytest.raises(ValueError, match="no negative"):
            list(call("add", [(1,), (-1,)]))


def test_streams_of_other_keys_are_other_numbers():
    draws = [parallel.generator(5, *key).random(4) for key in ((), (0,), (1,), (0, 1))]
    assert len(np.unique(np.concatenate(draws))) == 16
    assert (parallel.generator(5, 0, 1).random(4) == draws[3]).all()
