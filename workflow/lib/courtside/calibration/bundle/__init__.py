"""Bundle adjustment: the problem, its solver, choice of tie points, parts of a walk."""
