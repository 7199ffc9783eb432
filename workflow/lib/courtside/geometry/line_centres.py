"""Line centres clicked instead of edges: what ties between images and clicks say of it together."""

from dataclasses import replace

import numpy as np

from courtside.geometry import bundle, court_adjustment, courts

SHIFTS = (0.0, 0.5, 1.0)  # in half line widths


def shift(ties, clicks, court, **weights):
    """Find how far, in half line widths, the clicks lie inwards of the edges that the court names.

    Parameters
    ----------
    ties : courtside.geometry.court_adjustment.Ties
        Of a session with a court.
    clicks : dict of str to (P, 2) float
        By camera; NaN where not clicked.
    court : courtside.geometry.courts.Court
    **weights
        Of the clicks, as for `court_adjustment.solve`.

    Returns
    -------
    shift : float
        0 where edges were clicked, 1 where line centres were.
    sigma : float
        Its standard deviation; inf where the clicks do not tell.

    Notes
    -----
    The cameras are solved for the court as it is, half way, and with all points at line centres; the cost is
    a parabola of the shift, whose minimum and curvature are wanted. `click_faults.line_centre_pattern`, which
    looks at where adjusted cameras put the points, finds a third of it: the cameras have swallowed the rest.
    """
    inwards, costs = courts.to_line_centres(court), []
    for share in SHIFTS:
        moved = replace(court, xyz=court.xyz + share * inwards)
        solved = court_adjustment.solve(ties, clicks, moved, max_iterations=30, **weights)
        costs.append(bundle.cost(solved.network, ties.knowledge))
    bend, slope, _ = np.polyfit(SHIFTS, costs, 2)
    if bend < 1e-9 * max(costs[0], 1.0):
        return 0.0, np.inf
    return float(-slope / (2 * bend)), float(1 / np.sqrt(2 * bend))
