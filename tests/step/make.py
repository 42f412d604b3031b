"""Draws the STEP files beside it: a peg with a fillet, and the hole with a chamfer that it enters. In mm, facing +z:

    peg.step      plate 24 x 24 x 4 below z = 0; on it a pin, radius 5, up to z = 20, its edge rounded by 2
    socket.step   block 30 x 30 x 30 below z = 0; in it a hole, radius 5.2, 18 deep, its mouth a cone of 45 deg to radius 9.2

    .venv/bin/python tests/step/make.py
"""

import os
from pathlib import Path

from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepFilletAPI import BRepFilletAPI_MakeFillet
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox, BRepPrimAPI_MakeCone, BRepPrimAPI_MakeCylinder
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt
from OCP.STEPControl import STEPControl_AsIs, STEPControl_Writer
from OCP.TopAbs import TopAbs_EDGE
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS

as_edge = getattr(TopoDS, "Edge_s", None) or TopoDS.Edge


def axis(z):
    return gp_Ax2(gp_Pnt(0, 0, z), gp_Dir(0, 0, 1))


def cylinder(radius, height, z=0.0):
    return BRepPrimAPI_MakeCylinder(axis(z), radius, height).Shape()


def cone(low, high, height, z):
    return BRepPrimAPI_MakeCone(axis(z), low, high, height).Shape()


def block(low, high):
    return BRepPrimAPI_MakeBox(gp_Pnt(*low), gp_Pnt(*high)).Shape()


def write(path, *shapes):
    writer = STEPControl_Writer()
    # The writer prints its progress to stdout.
    stdout, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    for shape in shapes:
        writer.Transfer(shape, STEPControl_AsIs)
    writer.Write(str(path))
    os.dup2(stdout, 1)
    os.close(stdout)
    os.close(nowhere)


def peg():
    pin = cylinder(5, 20)
    fillet = BRepFilletAPI_MakeFillet(pin)
    explorer = TopExp_Explorer(pin, TopAbs_EDGE)
    while explorer.More():
        edge = as_edge(explorer.Current())
        curve = BRepAdaptor_Curve(edge)
        ends = [curve.Value(t) for t in (curve.FirstParameter(), 0.5 * (curve.FirstParameter() + curve.LastParameter()))]
        if all(abs(end.Z() - 20) < 1e-9 for end in ends) and fillet.Contour(edge) == 0:
            fillet.Add(2.0, edge)
        explorer.Next()
    return BRepAlgoAPI_Fuse(fillet.Shape(), block((-12, -12, -4), (12, 12, 0))).Shape()


def socket():
    hole = BRepAlgoAPI_Cut(block((-15, -15, -30), (15, 15, 0)), cylinder(5.2, 18, -18)).Shape()
    return BRepAlgoAPI_Cut(hole, cone(5.2, 9.2, 4, -4)).Shape()


if __name__ == "__main__":
    here = Path(__file__).parent
    write(here / "peg.step", peg())
    write(here / "socket.step", socket())
