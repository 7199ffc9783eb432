"""Bodies eliminated from normal equations: against the equations of all unknowns together."""

from dataclasses import replace

import numpy as np

from courtside.calibration.bundle import elimination
from fixtures.cameras import networks_made

N_BODIES, N_OWN, N_OTHERS = 5, 6, 2  # nothing is seen of the last body


def random_rows(network, rng):
    count = len(network.xy)
    sizes = (19, N_OTHERS, N_OWN)
    root = rng.uniform(0.5, 2.0, count)
    off, terms = rng.normal(size=(count, 2)), [rng.normal(size=(count, 2, size)) for size in sizes]
    root[3], off[3] = 0.0, np.nan  # a point behind its image
    body = network.point_idx % (N_BODIES - 1)
    return elimination.Rows(off, *terms, body, root)


def together(network, rows, known):
    """Return information and gradient of cameras, others and bodies, by one row per residual."""
    by_body = np.zeros((len(rows.off), 2, N_BODIES, N_OWN))
    by_body[np.arange(len(rows.off)), :, rows.body] = rows.by_body
    parts = (
        network.over_columns(rows.by_camera),
        rows.by_others,
        by_body.reshape(*rows.off.shape, -1),
    )
    used = np.repeat(rows.root > 0, 2)
    root = np.repeat(rows.root, 2)[used]
    slopes = np.concatenate(parts, axis=2).reshape(len(used), -1)[used] * root[:, None]
    off = rows.off.ravel()[used] * root
    lens = network.lens_sigma.ravel() ** -2.0
    lenses = lens, lens * (network.lens - network.lens_mean).ravel()
    first = np.zeros(network.n_columns - lens.size)
    information, pull = (
        np.concatenate([first, *each]) for each in zip(lenses, *known, strict=True)
    )
    return slopes.T @ slopes + np.diag(information), slopes.T @ off + pull


def test_the_step_is_that_of_all_unknowns_together():
    rng, made = np.random.default_rng(0), networks_made.make(3, 40)
    network = replace(
        made, lens_mean=made.lens + 0.1, lens_sigma=rng.uniform(0.5, 2.0, made.lens.shape)
    )
    rows = random_rows(network, rng)
    active = rng.random(network.n_columns + N_OTHERS) < 0.7
    others = rng.uniform(0.1, 1.0, (2, N_OTHERS))
    bodies = np.zeros((2, N_BODIES, N_OWN))
    bodies[:, :2] = rng.uniform(0.1, 1.0, (2, 2, N_OWN))
    found = elimination.normal_equations(
        network, rows, active, tuple(others), tuple(bodies), damping=0.0
    )
    whole, gradient = together(network, rows, (others, bodies.reshape(2, -1)))
    seen = np.repeat(np.arange(N_BODIES) < N_BODIES - 1, N_OWN)
    free = np.flatnonzero(np.append(active, seen))
    expected = -np.linalg.solve(whole[np.ix_(free, free)], gradient[free])
    step, own = found.step(0.0)
    np.testing.assert_allclose(step, expected[: active.sum()], atol=1e-9)
    np.testing.assert_allclose(own[:-1].ravel(), expected[active.sum() :], atol=1e-9)
    np.testing.assert_array_equal(own[-1], 0.0)
    covariance = np.linalg.inv(whole[np.ix_(free, free)])[: active.sum(), : active.sum()]
    np.testing.assert_allclose(np.linalg.inv(found.information), covariance, atol=1e-9)


def test_a_damped_step_is_shorter_down_the_slope():
    rng, network = np.random.default_rng(1), networks_made.make(3, 40)
    rows, active = random_rows(network, rng), np.ones(network.n_columns + N_OTHERS, dtype=bool)
    nothing = (np.zeros(N_OTHERS),) * 2, (np.zeros((N_BODIES, N_OWN)),) * 2
    free, held = (
        elimination.normal_equations(network, rows, active, *nothing, damping).step(damping)[0]
        for damping in (1e-3, 1e3)
    )
    gradient = elimination.normal_equations(network, rows, active, *nothing, 0.0).gradient
    assert held @ gradient < 0 and np.linalg.norm(held) < 0.1 * np.linalg.norm(free)
