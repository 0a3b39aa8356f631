"""Draws a scene file as a camera sees it: solids as shaded facets, the farthest first."""

from __future__ import annotations

from dataclasses import dataclass

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

# Unity's frame: y up, left-handed, a camera looks along its own z. The direction towards the light, as in the samples'
# scenes.
_LIGHT = -Rotation.from_quat([0.40821789, -0.23456972, 0.10938165, 0.8754261]).apply([0.0, 0.0, 1.0])
_AMBIENT = 0.55


@dataclass(frozen=True)
class Camera:
    """Position in metres, rotation as a quaternion x, y, z, w."""

    position: tuple[float, float, float]
    rotation: tuple[float, float, float, float]

    def seen(self, points: np.ndarray) -> np.ndarray:
        """[..., 3] right and up in units of the distance, and the distance itself in metres."""
        local = Rotation.from_quat(self.rotation).inv().apply(np.reshape(points, (-1, 3)) - np.array(self.position))
        flat = np.c_[local[:, :2] / local[:, 2:], local[:, 2]]
        return flat.reshape(np.shape(points))


def facets(surface: dict) -> np.ndarray:
    """[N, 4, 3] quadrilaterals in metres, in the scene's frame, at the surface's rest pose."""
    rest = surface.get("motion", {}).get("keyframes", [surface])[0]
    turn = Rotation.from_quat(rest.get("rotation", surface.get("rotation", [0.0, 0.0, 0.0, 1.0])))
    shape = surface["shape"]
    if "box" in shape:
        local = _box(np.array(shape["box"]["size"]) / 2.0)
    elif "sphere" in shape:
        local = _ball(shape["sphere"]["radius"], 0.0)
    else:
        capsule = shape["capsule"]
        local = _ball(capsule["radius"], capsule["height"] / 2.0 - capsule["radius"])
    return turn.apply(local.reshape(-1, 3)).reshape(-1, 4, 3) + np.array(rest["position"])


def rest_of(surface: dict) -> np.ndarray:
    """Where a drawing shows a surface: its own place, or the first of its motion."""
    return np.array(surface.get("motion", {}).get("keyframes", [surface])[0]["position"])


def outline(surface: dict, plane_of: list[int]) -> np.ndarray:
    """[n, 2] corners in a view along an axis of the world."""
    points = facets(surface).reshape(-1, 3)[:, plane_of]
    return points[ConvexHull(points).vertices]


def _box(half: np.ndarray) -> np.ndarray:
    faces = []
    for axis in range(3):
        right, up = (axis + 1) % 3, (axis + 2) % 3
        steps = 12 if half[right] + half[up] > 0.5 else 2
        edges = np.linspace(-1.0, 1.0, steps + 1)
        for side in (-1.0, 1.0):
            for a, b in np.ndindex(steps, steps):
                corner = np.zeros((4, 3))
                corner[:, axis] = side
                corner[:, right] = edges[[a, a + 1, a + 1, a]]
                corner[:, up] = edges[[b, b, b + 1, b + 1]]
                faces.append(corner * half)
    return np.array(faces)


def _ball(radius: float, reach: float) -> np.ndarray:
    """A sphere; with a reach above 0 a capsule along y."""
    rings, parts = 24, 48
    heights = np.linspace(-np.pi / 2.0, np.pi / 2.0, rings + 1)
    turns = np.linspace(0.0, 2.0 * np.pi, parts + 1)

    def point(ring: int, part: int) -> list[float]:
        wide = radius * np.cos(heights[ring])
        lift = reach if ring > rings // 2 else -reach
        return [wide * np.cos(turns[part]), radius * np.sin(heights[ring]) + lift, wide * np.sin(turns[part])]

    return np.array([
        [point(ring, part), point(ring, part + 1), point(ring + 1, part + 1), point(ring + 1, part)]
        for ring, part in np.ndindex(rings, parts)
    ])  # fmt: skip


def draw_solids(axes: plt.Axes, camera: Camera, solids: list[tuple[np.ndarray, str]]) -> None:
    """Facets [N, 4, 3] of each solid in its colour: only those that face the camera, the farthest solids first."""
    for faces, colour in solids:
        normals = np.cross(faces[:, 1] - faces[:, 0], faces[:, 3] - faces[:, 0]) + np.cross(
            faces[:, 3] - faces[:, 2], faces[:, 1] - faces[:, 2]
        )
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
        kept = lengths[:, 0] > 1e-12
        faces, normals = faces[kept], normals[kept] / lengths[kept]
        middles = faces.mean(axis=1)
        # Outwards from the solid's centre, because all of them are convex.
        normals *= np.where(np.sum(normals * (middles - middles.mean(axis=0)), axis=1, keepdims=True) < 0.0, -1.0, 1.0)
        facing = np.sum(normals * (np.array(camera.position) - middles), axis=1) > 0.0
        seen = camera.seen(faces[facing])
        order = np.argsort(-seen[..., 2].mean(axis=1))
        light = _AMBIENT + (1.0 - _AMBIENT) * np.clip(normals[facing] @ _LIGHT, 0.0, 1.0)
        colours = np.clip(light[:, None] * np.array(to_rgb(colour)), 0.0, 1.0)[order]
        axes.add_collection(PolyCollection(seen[order][..., :2], facecolors=colours, edgecolors=colours, linewidths=0.4))
