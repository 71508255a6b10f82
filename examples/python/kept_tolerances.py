"""I asked for 0.1 mm: did I get it? Five shapes through what people use, measured by witnesses that share no code with limitmesh.

The sphere, the cylinder and the torus have formulas. The rabbit and the cup have Loop's limit surface, here by the subdivision of trimesh
and the closed form of limit positions. VTK finds the distances. All tools get the same coarse mesh, but OpenSCAD, which has the formula.
Tools that are not installed are left out. Times are processor time of all threads, the least of three runs.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from resource import RUSAGE_CHILDREN, RUSAGE_SELF, getrusage
from typing import Any

import numpy as np

import limitmesh

missing = [library for library in ("scipy", "trimesh", "vtk") if not find_spec(library)]
if missing:
    print("skipped: there is no", ", ".join(missing))
    sys.exit()

import trimesh
import vtk
from scipy import sparse
from scipy.sparse import linalg
from vtk.util import numpy_support

ASKED = 0.1
Arrays = tuple[np.ndarray, np.ndarray]
Distance = Callable[[np.ndarray], np.ndarray]


@dataclass
class Truth:
    """A surface: how far points are from it, and many points on it."""

    away: Distance
    points: np.ndarray


@dataclass
class Shape:
    """A coarse mesh, and the surface that it is meant to have. A formula has an OpenSCAD program and a greatest radius of turning."""

    name: str
    mesh: Arrays
    truth: Truth
    scad: str = ""
    radius: float = 0.0
    is_part: bool = False


# Distances.


def polydata(mesh: Arrays) -> Any:
    points, cells, data = vtk.vtkPoints(), vtk.vtkCellArray(), vtk.vtkPolyData()
    points.SetData(numpy_support.numpy_to_vtk(np.ascontiguousarray(mesh[0], dtype=np.float64), deep=True))
    cells.SetData(3, numpy_support.numpy_to_vtkIdTypeArray(np.ascontiguousarray(mesh[1], dtype=np.int64).ravel(), deep=True))
    data.SetPoints(points)
    data.SetPolys(cells)
    return data


def to_mesh(mesh: Arrays) -> Distance:
    """The distance of points to a mesh."""
    implicit = vtk.vtkImplicitPolyDataDistance()
    implicit.SetInput(polydata(mesh))

    def away(points: np.ndarray) -> np.ndarray:
        found = vtk.vtkDoubleArray()
        implicit.FunctionValue(numpy_support.numpy_to_vtk(np.ascontiguousarray(points), deep=True), found)
        return np.abs(numpy_support.vtk_to_numpy(found))

    return away


def got(mesh: Arrays, truth: Truth) -> float:
    """The symmetric Hausdorff distance, from 10 points or more on each triangle, and tens of thousands on the surface."""
    steps = max(3, min(40, round((600_000 / len(mesh[1])) ** 0.5)))
    grid = np.array([(i, j, steps - i - j) for i in range(steps + 1) for j in range(steps + 1 - i)]) / steps
    samples = np.einsum("gc,fcx->fgx", grid, mesh[0][mesh[1]]).reshape(-1, 3)
    return max(truth.away(samples).max(), to_mesh(mesh)(truth.points).max())


# Shapes, in millimetres.


def sphere(radius: float = 25.0) -> Shape:
    ball = trimesh.creation.icosphere(2, radius)
    truth = Truth(lambda p: np.abs(np.linalg.norm(p, axis=1) - radius), trimesh.creation.icosphere(6, radius).vertices)
    return Shape("sphere, radius 25 mm", (ball.vertices, ball.faces), truth, f"sphere({radius});", radius)


def cylinder(radius: float = 20.0, height: float = 60.0) -> Shape:
    def away(p: np.ndarray) -> np.ndarray:
        out = np.stack([np.hypot(p[:, 0], p[:, 1]) - radius, np.abs(p[:, 2]) - height / 2])
        return np.where(out.max(axis=0) > 0, np.linalg.norm(np.maximum(out, 0), axis=0), -out.max(axis=0))

    angle, part = (axis.ravel() for axis in np.meshgrid(np.arange(2000) * np.pi / 1000, np.linspace(0, 1, 21)))
    side = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), (part - 0.5) * height])
    ends = [np.column_stack([side[:, :2] * part[:, None], np.full(len(side), z)]) for z in (-height / 2, height / 2)]
    coarse = trimesh.creation.cylinder(radius, height, sections=24)
    scad = f"cylinder({height}, {radius}, {radius}, center=true);"
    truth = Truth(away, np.concatenate([side, *ends]))
    return Shape("cylinder, radius 20 mm, height 60 mm", (coarse.vertices, coarse.faces), truth, scad, radius, is_part=True)


def torus(large: float = 30.0, small: float = 10.0) -> Shape:
    def at(across: int, along: int) -> np.ndarray:
        v, u = (axis.ravel() for axis in np.meshgrid(np.arange(along) * 2 * np.pi / along, np.arange(across) * 2 * np.pi / across))
        ring = large + small * np.cos(v)
        return np.column_stack([ring * np.cos(u), ring * np.sin(u), small * np.sin(v)])

    here = np.arange(512).reshape(32, 16)
    right, up, both = (np.roll(here, step, axis).ravel() for step, axis in ((-1, 0), (-1, 1), ((-1, -1), (0, 1))))
    faces = np.concatenate([np.stack([here.ravel(), right, both], 1), np.stack([here.ravel(), both, up], 1)])
    truth = Truth(lambda p: np.abs(np.hypot(np.hypot(p[:, 0], p[:, 1]) - large, p[:, 2]) - small), at(400, 100))
    scad = f"rotate_extrude() translate([{large}, 0]) circle({small});"
    return Shape("torus, radii 30 mm and 10 mm", (at(32, 16), faces), truth, scad, large + small)


def limits(vertices: np.ndarray, faces: np.ndarray) -> sparse.csr_array:
    """The matrix that takes the vertices of a closed mesh to their points on Loop's limit surface (Loop 1987)."""
    edges = trimesh.Trimesh(vertices, faces, process=False).edges_unique
    starts, ends = np.concatenate([edges, edges[:, ::-1]]).T
    valence = np.bincount(starts)
    beta = (5 / 8 - (3 / 8 + np.cos(2 * np.pi / valence) / 4) ** 2) / valence
    weight = 1 / (valence + 3 / (8 * beta))
    return sparse.csr_array((weight[starts], (starts, ends))) + sparse.diags_array(1 - valence * weight)


def loop(mesh: Arrays, levels: int) -> Truth:
    """Loop's limit surface of a closed mesh: its points after so many subdivisions, with triangles between them."""
    vertices, faces = trimesh.remesh.subdivide_loop(*mesh, iterations=levels)
    points = limits(vertices, faces) @ vertices
    return Truth(to_mesh((points, faces)), points[::5])


def cage(name: str, title: str) -> Shape:
    """A built-in model, scaled to a diagonal of 100 mm, and its limit surface."""
    model = limitmesh.load(f"builtin:{name}")
    mesh = (np.asarray(model.vertices) * (100 / np.linalg.norm(np.ptp(model.vertices, axis=0))), np.asarray(model.faces))
    truth = loop(mesh, 5)
    # Halving the edges quarters the distance, so that what is left is a third of what the last step changed.
    left = loop(mesh, 4).away(truth.points).max() / 3
    return Shape(f"{title}, diagonal 100 mm, Loop's limit surface, which the witness has to {left:.3f} mm", mesh, truth)


# Tools: a name, what was asked, how it makes the mesh, and a surface of its own if it is measured against that.

Row = tuple[str, str, Callable[[], Arrays], Truth | None]


def own(shape: Shape) -> Iterator[Row]:
    def made(options: dict[str, Any]) -> Arrays:
        smooth = limitmesh.refine(*shape.mesh, **options)
        return smooth.vertices, smooth.faces

    asked: dict[str, Any] = {"tolerance": ASKED}
    ways: list[dict[str, Any]] = [{}, {"balance": True}, {"optimize": True}]
    if shape.is_part:
        ways = [{"creases": "auto"}]
    elif shape.scad:
        ways = [{}, {"interpolate": True}, {"interpolate": True, "balance": True}]
    for way in ways:
        make = partial(made, asked | way)
        name = ", ".join(["limitmesh", *way])
        yield name, f"tolerance {ASKED}", make, None
        if way == {"interpolate": True}:
            # The control points whose limits are the vertices.
            control = linalg.spsolve(limits(*shape.mesh).tocsc(), shape.mesh[0])
            yield f"{name}, against its own surface", f"tolerance {ASKED}", make, loop((control, shape.mesh[1]), 5)
    if not shape.scad:
        yield "limitmesh, uniform", "level 2", partial(made, {"method": "uniform", "levels": 2}), None


def openscad(shape: Shape) -> Iterator[Row]:
    def made(setting: str) -> Arrays:
        with tempfile.TemporaryDirectory() as folder:
            source, target = Path(folder, "shape.scad"), Path(folder, "shape.stl")
            source.write_text(f"{setting}; {shape.scad}")
            subprocess.run(["openscad", "-o", target, source], check=True, capture_output=True)
            mesh = trimesh.load_mesh(target)
            return mesh.vertices, mesh.faces

    if shape.scad and shutil.which("openscad"):
        # So many sides have a sagitta of the tolerance.
        sides = int(np.ceil(np.pi / np.arccos(1 - ASKED / shape.radius)))
        for setting in (f"$fs = {ASKED}", f"$fn = {sides}"):
            yield "OpenSCAD", f"`{setting}`", partial(made, setting), None


def manifold(shape: Shape) -> Iterator[Row]:
    if not find_spec("manifold3d"):
        return
    import manifold3d

    def solid() -> Any:
        corners, faces = np.asarray(shape.mesh[0], dtype=np.float32), np.asarray(shape.mesh[1], dtype=np.uint32)
        # Cages are smooth all over; with some of their edges sharp, 3.5.4 crashes.
        return manifold3d.Manifold(manifold3d.Mesh(corners, faces)).smooth_out(*([] if shape.scad else [180]))

    def made(fine: Any) -> Arrays:
        mesh = fine.to_mesh()
        return np.asarray(mesh.vert_properties[:, :3], dtype=np.float64), np.asarray(mesh.tri_verts, dtype=np.int64)

    dense = made(solid().refine(32))
    truths = [None] * bool(shape.scad) + [Truth(to_mesh(dense), dense[0][::5])]
    for truth in truths:
        name = "manifold, against its own surface" if truth else "manifold"
        yield name, f"tolerance {ASKED}", lambda: made(solid().refine_to_tolerance(ASKED)), truth


def mmg(shape: Shape) -> Iterator[Row]:
    if not shape.scad or not find_spec("mmgpy"):
        return
    import mmgpy

    def made() -> Arrays:
        mesh = mmgpy.MmgMeshS(np.asarray(shape.mesh[0], dtype=np.float64), np.asarray(shape.mesh[1], dtype=np.int32))
        mesh.remesh(hausd=ASKED, verbose=-1)
        return mesh.get_vertices(), mesh.get_triangles()

    yield "MMG", f"`hausd` {ASKED}", made, None


def adaptive_vtk(shape: Shape) -> Iterator[Row]:
    def made() -> Arrays:
        adaptive = vtk.vtkAdaptiveSubdivisionFilter()
        adaptive.SetInputData(polydata(shape.mesh))
        adaptive.SetMaximumEdgeLength(edge)
        adaptive.SetMaximumTriangleArea(edge**2)
        adaptive.Update()
        data = adaptive.GetOutput()
        faces = numpy_support.vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        return numpy_support.vtk_to_numpy(data.GetPoints().GetData()), faces

    # A chord so long has a sagitta of the tolerance.
    edge = (8 * ASKED * shape.radius) ** 0.5
    if shape.scad:
        yield "VTK, adaptive", f"edges of {edge:.1f} mm", made, None


def by_level(shape: Shape) -> Iterator[Row]:
    def meshlab(level: int) -> Arrays:
        import pymeshlab

        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(*shape.mesh))
        meshes.meshing_surface_subdivision_loop(iterations=level, threshold=pymeshlab.PercentageValue(0))
        return meshes.current_mesh().vertex_matrix(), meshes.current_mesh().face_matrix()

    for level in (2,) if shape.scad else (2, 3):
        yield "trimesh, Loop", f"level {level}", partial(trimesh.remesh.subdivide_loop, *shape.mesh, iterations=level), None
        if find_spec("pymeshlab"):
            yield "MeshLab, Loop", f"level {level}", partial(meshlab, level), None


# Tables.


def timed(make: Callable[[], Arrays]) -> tuple[Arrays, float]:
    """A mesh, and the seconds that it took this process and those that it started."""

    def seconds() -> float:
        return sum(usage.ru_utime + usage.ru_stime for usage in map(getrusage, (RUSAGE_SELF, RUSAGE_CHILDREN)))

    times = []
    for _ in range(3):
        began = seconds()
        mesh = make()
        times.append(seconds() - began)
    return mesh, min(times)


def table(shape: Shape) -> None:
    print(f"\n{shape.name}; {len(shape.mesh[1]):,} triangles:\n")
    print("| tool | asked | got, mm | kept | triangles | seconds |\n|---|---|---|---|---|---|")
    for tool in (own, openscad, manifold, mmg, adaptive_vtk, by_level):
        for name, asked, make, truth in tool(shape):
            mesh, seconds = timed(make)
            off = got(mesh, truth or shape.truth)
            print(f"| {name} | {asked} | {off:.4f} | {'yes' if off <= ASKED else 'no'} | {len(mesh[1]):,} | {seconds:.3f} |", flush=True)


for shape in (sphere(), cylinder(), torus(), cage("bunny", "rabbit"), cage("cup", "cup")):
    table(shape)
libraries = ("limitmesh", "manifold3d", "mmgpy", "vtk", "trimesh", "pymeshlab", "numpy")
print("\n" + ", ".join(f"{library} {version(library)}" for library in libraries if find_spec(library)))
