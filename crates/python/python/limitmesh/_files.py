"""Meshes written to files, and files refined as the program does."""

from __future__ import annotations

import json
import os
import tempfile
from typing import Any

from . import _limitmesh, _options, _short
from ._inputs import MeshLike, as_mesh
from ._limitmesh import OptionError
from ._options import Boundary, Count, Length, Method, ProgressCallback, Scheme
from ._refined import Refined
from ._simplify import repair
from ._write import write


def save(path: str | os.PathLike[str], mesh: Refined | MeshLike, *, ascii: bool = False) -> None:
    """Writes triangles and what they carry to a file, whole or not at all.

    What its format has no place for is left out: STL holds triangles alone, OBJ and PLY texture coordinates and colours, too, and
    PLY any other channel.

    Parameters
    ----------
    path
        The file, whose extension (.obj, .ply, .stl, .off, .gltf, .glb, .3mf) chooses the format.
    mesh
        A result, with its limit normals; or a mesh, which is mended first where that is needed.
    ascii
        Text where the format has a binary form as well.

    Raises
    ------
    ReadError
        It cannot be written.

    Examples
    --------
    >>> import limitmesh, os, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = os.path.join(folder, "cube.obj")
    ...     limitmesh.save(path, "builtin:cube")
    ...     limitmesh.info(path)["triangles"]
    12
    """
    if isinstance(mesh, Refined):
        mesh.save(path, ascii=ascii)
        return
    given = as_mesh(mesh)
    mended = repair(given)
    linked = (given.material_libraries, given.texture_files)
    write(path, mended.vertices, mended.faces, None, mended.channels, linked, ascii=ascii)


def refine_file(
    source: str | os.PathLike[str],
    target: str | os.PathLike[str],
    *,
    tolerance: Length | None = None,
    within: Length | None = None,
    triangles: Count | None = None,
    angle: float | None = None,
    interpolate: bool | Length | None = None,
    creases: str | None = None,
    crease_angle: float | None = None,
    boundary: Boundary = "smooth",
    concave_corners: str | None = None,
    scheme: Scheme | None = None,
    smooth_triangles: bool = False,
    method: Method = "exact",
    levels: int | None = None,
    optimize: bool = False,
    balance: bool = False,
    uv: str = "boundaries",
    weld: float | None = 0.0,
    repair: bool = True,
    split_normals: bool = False,
    provenance: bool = False,
    proof: str | os.PathLike[str] | None = None,
    ascii: bool = False,
    overwrite: bool = False,
    max_triangles: Count | None = None,
    max_levels: int | None = None,
    max_memory: float | str | None = "50%",
    strict: bool = False,
    threads: int | None = None,
    progress: ProgressCallback | None = None,
) -> dict[str, Any]:
    """Refines a file as the program ``limitmesh refine`` does, with all that the file carries, and gives its report.

    From glTF to glTF the asset is edited: its triangles are replaced, and everything else stays to the byte. Files are written
    whole or not at all.

    Parameters
    ----------
    source
        OBJ, PLY, STL, OFF, glTF or 3MF, or ``"builtin:NAME"``.
    target
        The file to write, whose extension chooses the format.
    uv
        How texture coordinates follow the surface: "boundaries" (seams stay), "none", "corners-only", "corners-plus1",
        "corners-plus2", or "linear".
    split_normals, provenance
        In PLY files: a vertex for each side of sharp edges, and where vertices and triangles came from.
    proof
        A file for a proof of the distance, which the program ``limitmesh-check`` confirms. OBJ, PLY and OFF; flat regions stay divided.
    ascii
        PLY and STL as text.
    creases
        "auto" keeps the edges of parts sharp and leads their surface through the vertices, where the file does not say itself which
        edges are sharp; "none" keeps none but those that it does. By default "auto" for exact refinement, as in the program.
    overwrite
        Whether the target may be a file that is read.
    tolerance, within, triangles, angle, interpolate, crease_angle, boundary, concave_corners, scheme, smooth_triangles, method, levels, optimize, balance, \
weld, repair, max_triangles, max_levels, max_memory, strict, threads, progress
        As for `refine`.

    Returns
    -------
    dict
        The report of the program, as docs/reports.md describes it; and ``notes``, lines that the program would print.

    Raises
    ------
    ReadError
        A file cannot be read or written, or gives no mesh.
    OptionError
        An option is out of range, or does not go with another or with the file.

    Examples
    --------
    >>> import limitmesh, os, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     report = limitmesh.refine_file("builtin:cup", os.path.join(folder, "cup.ply"), tolerance="0.2%")
    >>> report["stop"], report["error"]["certified"]
    ('met', True)
    """
    _options.one_of(creases, "creases", (None, "auto", "none"))
    are_found = creases == "auto" or (creases is None and method == "exact" and within is None)
    if are_found and crease_angle is None and interpolate is False:
        raise OptionError(
            "interpolate=False does not go with creases='auto' for files, the default; crease_angle keeps edges sharp alone, creases='none' none"
        )
    _options.control_of(
        interpolate=interpolate,
        auto_creases=creases == "auto",
        crease_angle=crease_angle,
        boundary=boundary,
        concave_corners=concave_corners,
        scheme=scheme,
        smooth_triangles=smooth_triangles,
        weld=weld,
    )
    goals = _options.goals_of(
        method=method, levels=levels, tolerance=tolerance, within=within, triangles=triangles, angle=angle, optimize=optimize,
        balance=balance, max_triangles=max_triangles, max_levels=max_levels, max_memory=max_memory,
    )
    arguments = [_name(source, "source"), f"--output={_name(target, 'target')}", f"--method={method}", f"--channel=uv={uv}"]
    arguments += [] if scheme is None else [f"--scheme={scheme}"]
    arguments.append(f"--boundary={boundary}")
    arguments.append("--weld=none" if weld is None else f"--weld={weld!r}")
    if interpolate is True:
        arguments.append("--interpolate")
    elif interpolate is not False and interpolate is not None:
        arguments.append(f"--interpolate={interpolate}")
    for name, value in (
        ("tolerance", tolerance),
        ("within", within),
        ("proof", None if proof is None else _name(proof, "proof")),
        ("crease-angle", creases if crease_angle is None else crease_angle),
        ("angle", angle),
        ("concave-corners", {"divided": "fixed", "as-tagged": "smooth"}.get(concave_corners or "")),
        ("triangles", goals["triangles"]),
        ("max-triangles", goals["max_triangles"]),
        ("levels", goals["max_levels"] if levels is None else goals["levels"]),
        ("max-memory", goals["max_memory"] if method == "exact" else None),
    ):
        if value is not None:
            arguments.append(f"--{name}={value}")
    for name, flag in (
        ("optimize", optimize),
        ("balance", balance),
        ("split-normals", split_normals),
        ("provenance", provenance),
        ("smooth-triangles", smooth_triangles),
        ("ascii", ascii),
        ("overwrite", overwrite),
        ("strict", not repair),
    ):
        if flag:
            arguments.append(f"--{name}")
    with tempfile.TemporaryDirectory(prefix="limitmesh-") as folder:
        path = os.path.join(folder, "report.json")
        short, notes = _limitmesh.refine_file(
            [*arguments, f"--report={path}"], *_options.work_of(threads, progress)
        )
        with open(path, encoding="utf-8") as file:
            report: dict[str, Any] = json.load(file)
    report["notes"] = notes
    _short.tell(short, report, strict)
    return report


def _name(path: str | os.PathLike[str], what: str) -> str:
    name = os.fspath(path)
    if not isinstance(name, str) or not name or name == "-":
        raise OptionError(f"{what} is {name!r}, expected the name of a file")
    # A name that begins like an option is none.
    return os.path.join(os.curdir, name) if name.startswith("-") else name
