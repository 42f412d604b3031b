"""A STEP file on stdin becomes the triangles of its solids on stdout, in mm.

    python3 -I -c "$(cat mesh.py)" DEFLECTION MOST_TRIANGLES MOST_BYTES MOST_SECONDS < part.step

DEFLECTION is in mm, or 0 for a share of the part's size. Asks for nothing but its input, and writes no file.

Out: a line of JSON; where it has no "error", then of every body its corners (three little-endian doubles each) and its triangles (three
little-endian unsigned 32-bit numbers of corners each). Corners that faces share at an edge are one corner, as the topology has it, whatever
the tolerances of the file: a closed shell becomes a closed mesh.
"""

import array
import json
import os
import signal
import site
import sys

# An isolated interpreter (-I) knows nothing of the folder at hand and of variables. Packages that were installed for the person alone, and those in
# absolute entries of PYTHONPATH, are searched last.
sys.path += [path for path in os.environ.get("PYTHONPATH", "").split(os.pathsep) if os.path.isabs(path)]
if sys.prefix == sys.base_prefix and os.path.isabs(site.getusersitepackages()):
    site.addsitedir(site.getusersitepackages())

# Default deflection of the facets, as a share of the largest side of the shape.
SHARE = 2e-4
# Attempts to mesh a part, each finer than the last, until OpenCASCADE keeps to the requested deflection.
TRIES = 4
# Largest angle between neighbouring facets, in rad, so that a small hole keeps its shape: 13 sides at least.
ANGLE = 0.5

# A person who interrupts does not wait until OpenCASCADE returns.
signal.signal(signal.SIGINT, signal.SIG_DFL)
# OpenCASCADE prints what it thinks to stdout.
out = os.fdopen(os.dup(1), "wb")
os.dup2(2, 1)


def answer(head, chunks=()):
    out.write(json.dumps(head).encode() + b"\n")
    for chunk in chunks:
        if sys.byteorder == "big":
            chunk.byteswap()
        out.write(chunk.tobytes())
    out.close()
    # Taking OpenCASCADE down properly takes longer than the system needs.
    os._exit(0)


def refuse(kind, message):
    answer({"error": kind, "message": message})


def limit(most_bytes, most_seconds):
    try:
        import resource

        # Its libraries alone take gigabytes of address space, and hardly any memory.
        limits = ((resource.RLIMIT_AS, most_bytes + (4 << 30)), (resource.RLIMIT_CPU, most_seconds))
        for which, most in limits:
            hard = resource.getrlimit(which)[1]
            if hard == resource.RLIM_INFINITY or most < hard:
                resource.setrlimit(which, (most, hard))
    except (ImportError, ValueError, OSError):
        # The one who started it watches the time as well.
        pass


deflection, most_triangles = float(sys.argv[1]), int(sys.argv[2])
limit(int(sys.argv[3]), int(sys.argv[4]))
source = sys.stdin.buffer.read()

try:
    import OCP
    from OCP.Bnd import Bnd_Box
    from OCP.BRep import BRep_Tool
    from OCP.BRepBndLib import BRepBndLib
    from OCP.BRepMesh import BRepMesh_IncrementalMesh
    from OCP.BRepTools import BRepTools
    from OCP.IFSelect import IFSelect_RetDone
    from OCP.Interface import Interface_Static
    from OCP.STEPControl import STEPControl_Reader
    from OCP.TopAbs import TopAbs_EDGE, TopAbs_FACE, TopAbs_FORWARD, TopAbs_REVERSED, TopAbs_SHELL, TopAbs_SOLID
    from OCP.TopExp import TopExp_Explorer
    from OCP.TopLoc import TopLoc_Location
    from OCP.TopoDS import TopoDS
except ImportError as error:
    refuse("package", str(error))


def cast(name):
    """TopoDS.Face and the like, whose names changed between versions."""
    found = getattr(TopoDS, name + "_s", None) or getattr(TopoDS, name, None)
    return found or (lambda shape: shape)


as_face, as_edge = cast("Face"), cast("Edge")


def explored(shape, kind, but_in=None):
    explorer = TopExp_Explorer(shape, kind) if but_in is None else TopExp_Explorer(shape, kind, but_in)
    while explorer.More():
        yield explorer.Current()
        explorer.Next()


def read():
    import io

    reader = STEPControl_Reader()
    Interface_Static.SetCVal_s("xstep.cascade.unit", "MM")
    if reader.ReadStream("part.step", io.BytesIO(source)) != IFSelect_RetDone:
        refuse("unreadable", "it is broken, or no STEP file")
    reader.TransferRoots()
    return reader.OneShape()


def bodies_of(shape):
    """Solids; where there is none, shells that are closed."""
    if shape is None or shape.IsNull():
        refuse("empty", "nothing in it has a shape")
    solids = list(explored(shape, TopAbs_SOLID))
    if solids:
        return solids
    shells = list(explored(shape, TopAbs_SHELL))
    closed = [shell for shell in shells if BRep_Tool.IsClosed_s(shell)]
    if not closed:
        faces = sum(1 for _ in explored(shape, TopAbs_FACE))
        refuse("empty", f"of {faces} faces, none of which bounds a solid" if faces else "nothing in it has faces")
    return closed


def largest_side(shape):
    box = Bnd_Box()
    BRepBndLib.AddOptimal_s(shape, box, False, False)
    if box.IsVoid():
        refuse("empty", "nothing in it has a size")
    low, high = box.CornerMin(), box.CornerMax()
    return max(high.X() - low.X(), high.Y() - low.Y(), high.Z() - low.Z())


class Corners:
    """Nodes of faces, those that are one joined."""

    def __init__(self):
        self.points, self.parent = [], []

    def add(self, point):
        self.points.append(point)
        self.parent.append(len(self.parent))
        return len(self.parent) - 1

    def root(self, k):
        while self.parent[k] != k:
            self.parent[k] = self.parent[self.parent[k]]
            k = self.parent[k]
        return k

    def join(self, a, b):
        a, b = self.root(a), self.root(b)
        # The earlier one stays.
        self.parent[max(a, b)] = min(a, b)


def farthest(solid):
    """How far the facets are off, as OpenCASCADE measures it."""
    off = 0.0
    for shape in explored(solid, TopAbs_FACE):
        mesh = BRep_Tool.Triangulation_s(as_face(shape), TopLoc_Location())
        off = max(off, mesh.Deflection() if mesh is not None else 0.0)
    return off


def body(solid, left):
    """Corners and triangles of a body, and how many more there may be."""
    corners, triangles = Corners(), []
    known = {}
    for shape in explored(solid, TopAbs_FACE):
        face = as_face(shape)
        location = TopLoc_Location()
        mesh = BRep_Tool.Triangulation_s(face, location)
        if mesh is None:
            refuse("unmeshed", "one of its faces cannot be meshed")
        move = location.Transformation()
        first = len(corners.points)
        for k in range(1, mesh.NbNodes() + 1):
            point = mesh.Node(k).Transformed(move)
            corners.add((point.X(), point.Y(), point.Z()))
        turned = (face.Orientation() == TopAbs_REVERSED) != move.IsNegative()
        left -= mesh.NbTriangles()
        if left < 0:
            refuse("many", str(most_triangles - left))
        for k in range(1, mesh.NbTriangles() + 1):
            a, b, c = (first - 1 + node for node in mesh.Triangle(k).Get())
            triangles.append((a, c, b) if turned else (a, b, c))
        # Of a seam the one side, and where the edge is reversed the other.
        for shape in explored(face.Oriented(TopAbs_FORWARD), TopAbs_EDGE):
            edge = as_edge(shape)
            polygon = BRep_Tool.PolygonOnTriangulation_s(edge, mesh, location)
            if polygon is None:
                continue
            nodes = [first - 1 + polygon.Node(k) for k in range(1, polygon.NbNodes() + 1)]
            if BRep_Tool.Degenerated_s(edge):
                # The pole of a sphere, the apex of a cone.
                for node in nodes:
                    corners.join(nodes[0], node)
                continue
            same = known.setdefault(hash(edge), [])
            other = next((nodes for seen, nodes in same if seen.IsSame(edge)), None)
            if other is None:
                same.append((edge, nodes))
            elif len(other) == len(nodes):
                for a, b in zip(other, nodes):
                    corners.join(a, b)
    numbers, points, kept = {}, array.array("d"), array.array("I")

    def number(corner):
        root = corners.root(corner)
        if root not in numbers:
            numbers[root] = len(numbers)
            points.extend(corners.points[root])
        return numbers[root]

    for triangle in triangles:
        a, b, c = (corners.root(corner) for corner in triangle)
        if a != b and b != c and c != a:
            kept.extend(map(number, (a, b, c)))
    return points, kept, left


def main():
    shape = read()
    parts = bodies_of(shape)
    most = deflection or SHARE * largest_side(shape)
    if not most > 0.0:
        refuse("empty", "it has no size")
    for part in parts:
        finer = most
        for _ in range(TRIES):
            BRepTools.Clean_s(part)
            # One thread: the same triangles every time.
            BRepMesh_IncrementalMesh(part, finer, False, ANGLE, False)
            off = farthest(part)
            if off <= most:
                break
            finer *= 0.9 * most / off
    heads, chunks, reached, left = [], [], 0.0, most_triangles
    for part in parts:
        points, triangles, left = body(part, left)
        reached = max(reached, farthest(part))
        heads.append([len(points) // 3, len(triangles) // 3])
        chunks += [points, triangles]
    version = getattr(OCP, "__version__", "of unknown version")
    answer({"bodies": heads, "deflection": most, "reached": reached, "by": f"OCP {version}"}, chunks)


try:
    main()
except MemoryError:
    refuse("memory", "")
except Exception as error:
    lines = str(error).strip().splitlines()
    refuse("unreadable", f"{type(error).__name__}: {lines[0] if lines else ''}"[:300])
