"""Polynomials through Chebyshev nodes, against the functions that they pass through."""

import numpy as np

from virtualgym.cameras import chebyshev


def test_a_polynomial_through_the_nodes_is_exact_at_every_pixel():
    nodes = chebyshev.nodes(640, 12)
    assert (np.diff(nodes) > 0).all() and nodes[0] > -0.5 and nodes[-1] < 639.5
    pixels = np.arange(640) / 640
    found = chebyshev.to_pixels(640, 12) @ ((nodes / 640) ** 7 - 3 * (nodes / 640) ** 2)
    np.testing.assert_allclose(found, pixels**7 - 3 * pixels**2, atol=1e-12)


def test_all_runs_round_alike():
    first = chebyshev.to_pixels(1920, 16)
    assert all((chebyshev.to_pixels(1920, 16) == first).all() for _ in range(5))
