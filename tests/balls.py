"""Balls that fly through a made-up hall: stand-ins for athletes, whose place at any time is known."""

import numpy as np

from virtualgym.body.mesh import Mesh

RINGS = 24


def sphere(rings=RINGS):
    """Return a unit sphere: vertices (V, 3), and triangles (F, 3) counter-clockwise seen from outside."""
    polar = np.linspace(0, np.pi, rings + 1)
    around = np.arange(2 * rings) * np.pi / rings
    polar, around = (values.ravel() for values in np.meshgrid(polar, around, indexing="ij"))
    vertices = np.column_stack(
        [np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar)]
    )
    at = np.arange(len(vertices)).reshape(rings + 1, -1)
    beside = np.roll(at, -1, axis=1)
    corners = (at[:-1], at[1:], beside[1:]), (at[:-1], beside[1:], beside[:-1])
    triangles = [np.stack(three, axis=-1).reshape(-1, 3) for three in corners]
    return vertices, np.concatenate(triangles)


class Ball:
    """A ball on a straight line, or as a function of time has it."""

    def __init__(self, place, velocity=(0, 0, 0), *, radius_m=0.3, bgr=(255, 255, 255)):
        self.place, self.velocity = np.array(place, float), np.array(velocity, float)
        self.radius_m = radius_m
        self.shape, self.triangles = sphere()
        self.colours = np.tile(np.uint8(bgr), (len(self.triangles), 1))

    def centre(self, time_s):
        return self.place + self.velocity * time_s

    def mesh(self, time_s):
        return Mesh(self.centre(time_s) + self.radius_m * self.shape, self.triangles, self.colours)


class Plate:
    """A box that stands still."""

    def __init__(self, low, high, bgr=(255, 255, 255)):
        corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
        self.vertices = np.array(low) + corners * (np.array(high) - low)
        faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        self.triangles = np.array([t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))])
        self.colours = np.tile(np.uint8(bgr), (len(self.triangles), 1))

    def mesh(self, time_s):
        return Mesh(self.vertices, self.triangles, self.colours)
