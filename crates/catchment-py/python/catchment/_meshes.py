"""Halves from meshes in memory. They become files that a design names; these files are never written to a disk."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ._arguments import array, unmasked
from ._errors import ArgumentError

#: A trimesh, any other object with `vertices` and `faces`, or the two arrays: (n, 3) coordinates and (m, 3) vertex indices,
#: counter-clockwise seen from outside.
Mesh: TypeAlias = Any


def arrays(mesh: Mesh, name: str) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Vertices (n, 3) and faces (m, 3) of a mesh."""
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
        vertices, faces = mesh.vertices, mesh.faces
    else:
        try:
            vertices, faces = mesh
        except (TypeError, ValueError):
            raise ArgumentError(
                f"{name}: a half is a trimesh or (vertices, faces), not {type(mesh).__name__}"
            ) from None
    points = array(vertices, f"{name}: vertices")
    corners = np.asarray(unmasked(faces, f"{name}: faces"))
    if points.ndim != 2 or points.shape[1] != 3:
        raise ArgumentError(f"{name}: vertices have the shape (n, 3), not {points.shape}")
    if corners.ndim != 2 or corners.shape[1] != 3 or corners.dtype.kind not in "iu":
        raise ArgumentError(f"{name}: faces are whole numbers of shape (m, 3), not {corners.dtype} of {corners.shape}")
    if corners.size and (corners.min() < 0 or corners.max() >= len(points)):
        raise ArgumentError(f"{name}: faces name corners from 0 to {len(points) - 1}; these go to {corners.max()}")
    return points, np.ascontiguousarray(corners, dtype=np.int32)


def ply(mesh: Mesh, name: str) -> bytes:
    """A mesh as a binary PLY file, with unchanged coordinates."""
    points, corners = arrays(mesh, name)
    head = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(points)}\nproperty double x\nproperty double y\nproperty double z\n"
        f"element face {len(corners)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    rows = np.empty(len(corners), dtype=[("n", "u1"), ("corners", "<i4", 3)])
    rows["n"], rows["corners"] = 3, corners
    return head.encode() + points.astype("<f8").tobytes() + rows.tobytes()
