#!/usr/bin/env python3
"""A second, slow and short checker of proofs, written from docs/certificate.md alone. Names and numbers of sections are those of that page.

    check.py CONTROL RESULT PROOF [--at U]

CONTROL may be - if the proof holds the control mesh. With --at, U takes the place of the length in the proof. Exit status: 0 confirmed, 1 refused
(each line names a triangle, counted from 0, and the condition that fails), 2 unreadable. Reads OFF, OBJ and PLY.

All decisions are made in integers. A coordinate is a whole number of units, one unit being 2^-70 of a power of two above m. Each operation rounds down,
so it adds less than one unit to the error of a coordinate, and takes convex combinations of what it is given: vertices of M 1; each of 40 levels 3 (the
rule, beta, the mixture), so 121; Bezier points of mirrored control points 3 * 121 + 1; a sub-triangle 4: 368 in all, in space 368 * sqrt(3) < 638.
Vertices of K: less than 2. U is lowered by SLACK = 1024 units for all of it. Lengths, tangents and sines are bounded on the safe side.

What the page leaves to choose: flaps are a little smaller than they may be (tan 80 degrees is taken as 5, roots are rounded down). The witness z for a
point is its foot if that is in T, else the nearest point of T's border, or the foot moved straight towards an edge until it is in the flap there. At
irregular corners control points are the hull, level after level, also for vertices of K: there are no limits and no cones.
"""
import hashlib, io, re, struct, sys
from fractions import Fraction
from functools import cached_property, lru_cache, partial
from math import frexp, gcd, isfinite, isqrt

BITS, SLACK, DEPTH = 70, 1024, 40
SCALE = 1 << 100  # 1 for tangents, sines and cosines
PLACE = 1 << 30  # 1 for the weights of places
FOREVER = 10  # a sharpness that never fades
HEADER = re.compile(rb"limitmesh proof 1\nscheme (loop|loop-warren)\nwithin ([0-9.eE+-]+)\ncontrol (\d+) (\d+) ([0-9a-f]{64}) (here|beside)\n"
                    rb"result (\d+) (\d+) ([0-9a-f]{64})\nend\n")
PLY_TYPES = dict(zip("char int8 uchar uint8 short int16 ushort uint16 int int32 uint uint32 float float32 double float64".split(), "bbBBhhHHiiIIffdd"))

class Refused(Exception): pass

def need(condition, text):
    if not condition: raise ValueError(text)

def read_mesh(path):
    with open(path, "rb") as file: data = file.read()
    if data.startswith(b"ply"): return read_ply(*re.split(rb"end_header\r?\n", data, maxsplit=1))
    lines = [words for words in (line.split("#")[0].split() for line in data.decode("utf-8", "replace").splitlines()) if words]
    if lines[0][0].endswith("OFF"):
        n, m = map(int, (lines[0][1:] or lines.pop(1))[:2])
        return [tuple(map(float, line[:3])) for line in lines[1:n + 1]], [tuple(map(int, line[1:int(line[0]) + 1])) for line in lines[n + 1:n + m + 1]]
    points, faces = [], []
    for kind, *words in lines:
        if kind == "v": points.append(tuple(map(float, words[:3])))
        if kind == "f": faces.append(tuple(n - 1 if n > 0 else len(points) + n for n in (int(word.split("/")[0]) for word in words)))
    return points, faces

def read_ply(head, body):
    elements, rows, stream, words = [], {"vertex": [], "face": []}, io.BytesIO(body), iter(body.split())
    for key, *rest in (line.split() for line in head.decode("utf-8", "replace").splitlines()):
        if key == "format": ascii = {"ascii": True, "binary_little_endian": False}[rest[0]]
        if key == "element": elements.append((rest[0], int(rest[1]), []))
        if key == "property": elements[-1][2].append((rest[-1], [PLY_TYPES[kind] for kind in rest[:-1] if kind != "list"]))
    read = lambda kind: (float if kind in "fd" else int)(next(words) if ascii else struct.unpack("<" + kind, stream.read(struct.calcsize(kind)))[0])
    for element, count, properties in elements:
        rows[element] = [{name: tuple([read(kinds[1]) for _ in range(read(kinds[0]))]) if kinds[1:] else read(kinds[0]) for name, kinds in properties}
                         for _ in range(count)]
    return ([(float(row["x"]), float(row["y"]), float(row["z"])) for row in rows["vertex"]],
            [row["vertex_indices"] if "vertex_indices" in row else row["vertex_index"] for row in rows["face"]])

def checked(mesh, n, m, digest, name):
    points, faces = mesh
    need(all(len(p) == 3 and all(map(isfinite, p)) for p in points), f"the {name} mesh has vertices that are no points")
    need(all(len(face) == 3 and 0 <= min(face) <= max(face) < len(points) for face in faces), f"the {name} mesh has faces that are no triangles")
    data = struct.pack(f"<II{3 * len(points)}d", len(points), len(faces), *(x + 0.0 for p in points for x in p))  # -0.0 + 0.0 is 0.0
    data += struct.pack(f"<{3 * len(faces)}I", *(v for face in faces for v in face))
    if (len(points), len(faces), hashlib.sha256(data).hexdigest()) != (n, m, digest): raise Refused(f"the {name} mesh or its hash is not that of the proof")
    return points, faces

def directed_edges(faces):
    return {(face[i], face[i - 2]): (n, i) for n, face in enumerate(faces) for i in range(3)}

class Proof:
    """The three files (section 7). A place is a control face, with the weights of its corners that are not 0, by the names of the corners."""
    def __init__(self, control, result, proof):
        with open(proof, "rb") as file: self.data = file.read()
        match = HEADER.match(self.data)
        need(match, "this is no proof of version 1")
        self.at, self.warren, self.within = match.end(), match[1] == b"loop-warren", Fraction(match[2].decode())
        n, m, numbers = int(match[3]), int(match[4]), (int(match[7]), int(match[8]), match[9].decode())
        meshes = [read_mesh(control)] if control != "-" else []
        if match[6] == b"here":
            meshes.append([[flat[i:i + 3] for i in range(0, len(flat), 3)] for flat in (self.take(f"<{3 * n}d"), self.take(f"<{3 * m}I"))])
        need(meshes, "the control mesh is in a file of its own")
        self.control, self.result = [checked(mesh, n, m, match[5].decode(), "control") for mesh in meshes][0], checked(read_mesh(result), *numbers, "result")
        self.border, self.edges = directed_edges(self.control[1]), directed_edges(self.result[1])
        self.sharp_edges = [(self.varint(), self.varint(), *self.take("<d")) for _ in range(self.varint())]
        self.sharp_vertices = [(self.varint(), *self.take("<d")) for _ in range(self.varint())]
        need(all(s >= 0 for *_, s in self.sharp_edges + self.sharp_vertices), "a sharpness is negative, or no number")
        need(all((a, b) in self.border or (b, a) in self.border for a, b, _ in self.sharp_edges), "a sharp edge is no edge of the control mesh")
        self.parents, self.places = self.read_parents(len(self.result[1])), {}
        for parent, triangle in zip(self.parents, self.result[1]):
            for i, v in enumerate(triangle):
                if v not in self.places: self.places[v] = parent, self.read_place(parent, triangle[i - 2], triangle[i - 1])
        need(self.at == len(self.data), "the proof goes on after its end")
    def take(self, form):
        self.at += struct.calcsize(form)
        return struct.unpack_from(form, self.data, self.at - struct.calcsize(form))
    def varint(self):
        byte, = self.take("B")
        return byte if byte < 128 else byte - 128 + (self.varint() << 7)
    def read_parents(self, total):
        parents, face, count = [], -1, None
        while len(parents) < total:
            byte, = self.take("B")
            faces = self.varint() if byte == 0 else 1
            z, count = (self.varint(), self.varint()) if byte == 255 else (2, byte or count)
            face += -(z + 1) // 2 if z % 2 else z // 2
            need(not 250 < byte < 255 and count is not None and len(parents) + faces * count <= total, "the numbers of parents make no sense")
            need(0 <= face <= face + faces - 1 < len(self.control[1]), "a parent is no control face")
            parents += [face + i for i in range(faces) for _ in range(count)]
            face += faces - 1
        return parents
    def read_place(self, parent, a, b):
        c, = self.take("B")
        need(c < 159 or c == 255, "the code of a place is unknown")
        if c < 153:
            i, j = [(i * PLACE // 16, j * PLACE // 16) for i in range(17) for j in range(17 - i)][c]
        elif c < 159:
            (_, ai, aj), (_, bi, bj) = self.weights(a, parent), self.weights(b, parent)
            p, q = ((0, 6), (3, 3), (0, 12), (4, 4), (2, 2), (0, 3))[c - 153]
            i, j = Fraction(p * (bi - ai) - q * (bj - aj), 6) + ai, Fraction(p * (bj - aj) + q * (bi - ai + bj - aj), 6) + aj
        else:
            (e,), i, j = self.take("B"), self.varint(), self.varint()
            i, j = i << 30 - e, j << 30 - e  # a negative shift raises ValueError
        need(i >= 0 and j >= 0 and i + j <= PLACE and i == int(i) and j == int(j), "a place is outside of its parent, or no multiple of 2^-30")
        return {v: w for v, w in zip(self.control[1][parent], (PLACE - int(i) - int(j), int(i), int(j))) if w}
    def weights(self, v, face):
        """The weights of the place of v in a face, or None if the face does not hold it."""
        home, named = self.places[v]
        weights = tuple(named.get(name, 0) for name in self.control[1][face])
        return weights if sum(weights) == PLACE and (len(named) < 3 or home == face) else None

def tiling(proof):
    """What is wrong with the tiling (section 1): pairs of a triangle and a condition."""
    border, edges, areas = proof.border, proof.edges, [0] * len(proof.control[1])
    if len(border) < 3 * len(areas) or any(a == b for a, b in border): yield "-", "a directed edge of the control mesh occurs twice"
    for n, (parent, triangle) in enumerate(zip(proof.parents, proof.result[1])):
        part = [proof.weights(v, parent) for v in triangle]
        if None in part:
            yield n, "its parent does not hold the places of its corners"
            continue
        (_, i, j), (_, k, l), (_, p, q) = part
        areas[parent] += (k - i) * (q - j) - (p - i) * (l - j)
        if (k - i) * (q - j) - (p - i) * (l - j) <= 0: yield n, "its part has no positive area"
        for i in range(3):
            a, b = triangle[i], triangle[i - 2]
            names = tuple(proof.places[a][1] | proof.places[b][1])
            if edges[a, b] != (n, i): yield n, f"edge {i} occurs twice in the same direction"
            elif (b, a) not in edges and not (len(names) == 2 and (names in border) != (names[::-1] in border)):
                yield n, f"edge {i} has one triangle only, and is not on such an edge of the control mesh"
            elif (b, a) in edges and len(names) > 2 and proof.parents[edges[b, a][0]] != parent:  # two faces with the same corners: not on the page
                yield n, f"edge {i} is inside of its parent, but its other triangle has another parent"
    for f in (f for f, area in enumerate(areas) if area != PLACE * PLACE):
        yield proof.parents.index(f) if f in proof.parents else "-", f"the areas of the parts in its parent, control face {f}, do not add up"

@lru_cache(None)
def beta(k, warren):
    """Beta times 2^128, off by less than 2: less than 300 terms are rounded at 2^-160, and what the alternating series leave out is less than that."""
    one, term, cosine = 1 << 160, 1 << 160, 0
    if warren: return (3 << 128) // (16 if k == 3 else 8 * k)
    arctan = lambda n: sum((-1) ** i * (one // ((2 * i + 1) * n ** (2 * i + 1))) for i in range(80))
    angle = 2 * (16 * arctan(5) - 4 * arctan(239)) // k
    for i in range(0, 120, 2):
        cosine, term = cosine + term, -term * angle * angle // (one * one * (i + 1) * (i + 2))
    return (5 * one // 8 - (3 * one // 8 + cosine // 4) ** 2 // one) // k >> 32

def fade(s): return s if s >= FOREVER else max(0, s - 1)

def combine(divisor, *terms): return tuple([sum([w * p[i] for w, p in terms]) // divisor for i in range(3)])

def mixture(w, p, q): return combine(w.denominator, (w.numerator, p), (w.denominator - w.numerator, q))

class Vertex:
    """A control point at one level (section 5). around() is: the neighbours, each with the one after it; and the sharpness of sharp edges, by neighbour."""
    next, sharp = cached_property(lambda self: self.around()[0]), cached_property(lambda self: self.around()[1])
    ring = cached_property(lambda self: list(dict.fromkeys([*self.next, *self.next.values()])))
    def __init__(self, p, own, warren, around): self.p, self.own, self.warren, self.around, self.halves = p, own, warren, around, {}
    def rule(self, own, creases):
        if own or len(creases) > 2: return self.p
        if len(creases) == 2: return combine(8, (6, self.p), *((1, n.p) for n in creases))
        b = beta(len(self.ring), self.warren)
        return combine(1 << 128, ((1 << 128) - len(self.ring) * b, self.p), *((b, n.p) for n in self.ring))
    @cached_property
    def child(self):
        fading = [s for s in (self.own, *self.sharp.values()) if 0 < s <= 1] or [1]
        own, later = fade(self.own), {n: fade(s) for n, s in self.sharp.items() if fade(s)}
        p = mixture(Fraction(sum(fading), len(fading)), self.rule(self.own, self.sharp), self.rule(own, later))
        return Vertex(p, own, self.warren, lambda: ({self.half(n): self.half(c) for n, c in self.next.items()}, {self.half(n): later[n] for n in later}))
    def half(self, other):
        """The new vertex on the edge to another one."""
        if other not in self.halves:
            a, b, s = self, other, self.sharp.get(other, 0)
            sides = [(a, b, a.next.get(b)), (b, a, next((n for n in a.next if a.next[n] is b), None))]
            p = combine(2, (1, a.p), (1, b.p))
            if s < 1: p = mixture(Fraction(s), p, combine(8, (3, a.p), (3, b.p), *((1, c.p) for _, _, c in sides)))
            around = lambda: (dict(pair for a, b, c in sides if c for pair in ((b.child, b.half(c)), (b.half(c), a.half(c)), (a.half(c), a.child))),
                              {end.child: fade(s) for end in (a, b) if fade(s)})
            a.halves[b] = b.halves[a] = Vertex(p, 0, a.warren, around)
        return self.halves[other]
    def six(self, n):
        """The six points around a regular vertex from n on, mirrored beyond a lasting crease, or None."""
        for s in () if self.own else self.sharp or [n]:
            ring = [s]
            while len(ring) < 6 and self.next.get(ring[-1], s) is not s: ring.append(self.next[ring[-1]])
            p = [v.p for v in ring]
            if not self.sharp and len(ring) == len(self.next) == 6: return p
            if len(self.sharp) == 2 and len(ring) > 3 and n in ring[:3] and self.sharp.get(ring[3], 0) >= FOREVER <= self.sharp[s]:
                p[4:] = combine(1, (1, p[3]), (1, self.p), (-1, p[2])), combine(1, (1, p[0]), (1, self.p), (-1, p[1]))
                return p[ring.index(n):] + p[:ring.index(n)]

# Bezier points near a corner, by their exponents: the weights, 24 in all, of the corner and of the six points around it, from the next corner on.
STENCILS = (((4, 0, 0), (12, 2, 2, 2, 2, 2, 2)), ((3, 1, 0), (12, 4, 3, 1, 0, 1, 3)), ((3, 0, 1), (12, 3, 4, 3, 1, 0, 1)),
            ((2, 2, 0), (8, 8, 4, 0, 0, 0, 4)), ((2, 1, 1), (10, 6, 6, 1, 0, 0, 1)))

# A cell is a face of the control mesh at some level: its three corners.

@lru_cache(None)
def bezier_net(cell):
    """Rows of Bezier points, net[k][j] having the exponents (4 - j - k, j, k), or None for an irregular cell."""
    net, sixes = [[None] * (5 - k) for k in range(5)], [v.six(cell[i - 2]) for i, v in enumerate(cell)]
    for i, (exponents, weights) in ((i, stencil) for i in range(3) for stencil in STENCILS if None not in sixes):
        net[exponents[2 - i]][exponents[1 - i]] = combine(24, *zip(weights, (cell[i].p, *sixes[i])))
    return net if None not in sixes else None

def children(cell):
    """The four cells of the next level, each with the map of weights to its own."""
    (a, b, c), (ab, bc, ca) = cell, (v.half(cell[i - 2]) for i, v in enumerate(cell))
    return (((a.child, ab, ca), lambda x, y, z: (x - y - z, 2 * y, 2 * z)), ((ab, b.child, bc), lambda x, y, z: (2 * x, y - z - x, 2 * z)),
            ((ca, bc, c.child), lambda x, y, z: (2 * x, 2 * y, z - x - y)), ((bc, ca, ab), lambda x, y, z: (y + z - x, z + x - y, x + y - z)))

def between(p, w, q, v):
    """A point of the line pq. Points are given by whole weights; the sum of those of a point counts as 1."""
    point = [w * x + v * y for x, y in zip(p, q)]
    return tuple([x // gcd(*point) for x in point])

def clip(polygon):
    """The part of a convex polygon, line or point where no weight is negative."""
    for i in range(3):
        pairs = list(zip(polygon, polygon[1:] + polygon[:1]))
        polygon = [r for p, q in pairs for r in [p] * (p[i] >= 0) + [between(p, abs(q[i]), q, abs(p[i]))] * (p[i] * q[i] < 0)]
    return list(dict.fromkeys(between(p, 1, p, 0) for p in polygon))

def split(polygon):
    if len(polygon) > 3: return [[polygon[0], *side] for side in zip(polygon[1:], polygon[2:])]
    a, b, *c = polygon
    middle = between(a, sum(b), b, sum(a))
    return [c + [a, middle], [b] + c + [middle]]

def casteljau(net, weights):
    (a, b, c), one = weights, sum(weights)
    return [[tuple([(a * x + b * y + c * z) // one for x, y, z in zip(p, q, r)]) for p, q, r in zip(row, row[1:], up)] for row, up in zip(net, net[1:])]

def bezier_points(net, corners):
    """Those over a triangle, line or point with these corners."""
    return net[0] if len(net) == 1 else [p for i, corner in enumerate(corners) for p in bezier_points(casteljau(net, corner), corners[i:])]

def passes(cell, polygon, tests, depth=DEPTH):
    """Whether the surface over a polygon, line or point in a cell can be divided into pieces such that all points of the hull of each pass some test."""
    net = bezier_net(cell)
    if not net or len(polygon) <= 3:
        points = bezier_points(net, polygon) if net else {n.p for v in cell for n in (v, *v.ring)}
        if any(all(map(test, points)) for test in tests): return True
        ends = [bezier_points(net, [p])[0] for p in polygon] if net else []  # points of the surface, so points of each hull that holds them
        if depth == 0 or not all(any(test(p) for test in tests) for p in ends): return False
    pieces = [(cell, piece) for piece in split(polygon)] if net else [(child, clip([to_child(*p) for p in polygon])) for child, to_child in children(cell)]
    pieces = [(child, piece) for child, piece in pieces if len(piece) >= min(len(polygon), 3)]
    return all(passes(child, piece, tests, depth - 1) for child, piece in (pieces if len(polygon) > 1 else pieces[:1]))

def minus(p, q): return p[0] - q[0], p[1] - q[1], p[2] - q[2]

def dot(p, q): return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]

def cross(p, q): return p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]

class Triangle:
    """A triangle of K (section 2). The lengths of its normal and edges are rounded down, so plus 1 they are rounded up."""
    def __init__(self, corners, u):
        self.t, self.u, self.folds = corners, u, [None] * 3
        self.e = [minus(corners[i - 2], corners[i]) for i in range(3)]
        self.normal = cross(self.e[0], self.e[1])
        self.inward, self.squares = [cross(self.normal, e) for e in self.e], [dot(e, e) for e in self.e]
        self.size, self.sizes = isqrt(dot(self.normal, self.normal)), [isqrt(square) for square in self.squares]
    def tangent(self, i):
        """That of the least of the angle at a corner and half of what the angle leaves of 180 degrees."""
        product = -dot(self.e[i], self.e[i - 1])
        half = (isqrt(self.squares[i] * self.squares[i - 1]) + product) * SCALE // (self.size + 1)
        return min(half, self.size * SCALE // product) if product > 0 else max(0, half)
    def join(self, i, other, j):
        """Notes tan x, sigma and cos(theta / 2), if the edge is joined."""
        cosine = dot(self.normal, other.normal) * SCALE // ((self.size + 1) * (other.size + 1))
        if self.size and other.size and cosine > 0:
            tangent = min(5 * SCALE, self.tangent(i), self.tangent(i - 2), other.tangent(j), other.tangent(j - 2))
            self.folds[i] = other.folds[j] = tangent, isqrt(2 * SCALE * (SCALE - cosine)) + 1, isqrt(SCALE * (SCALE + cosine) // 2)
    def chord(self, i, p):
        """Whether p is within U of edge i."""
        d, square = minus(p, self.t[i]), self.squares[i]
        along = dot(d, self.e[i])
        if 0 < along < square: return dot(d, d) * square - along * along <= self.u * self.u * square
        d = d if along <= 0 else minus(p, self.t[i - 2])
        return dot(d, d) <= self.u * self.u
    def frame(self, i, p):
        """The height |h| of p and its distance |g| from the line of edge i, rounded up; g rounded down, negative inside; how far the lens extends there."""
        d, size, square = minus(p, self.t[i]), self.sizes[i], self.squares[i]
        inside, along = dot(d, self.inward[i]), dot(d, self.e[i])
        room = min(along, square - along) * self.folds[i][0] // ((size + 1) * SCALE)
        return abs(dot(d, self.normal)) // self.size + 1, abs(inside) // (self.size * size) + 1, -inside // ((self.size + 1) * (size + 1)), room
    def flap(self, i, p):
        """Whether G(p, z) <= U for the z in the flap that is described at the top of this file."""
        height, far, outside, room = self.frame(i, p)
        depth = min(outside, room)
        left = self.u - self.folds[i][1] * depth // SCALE - 1
        return depth > 0 <= left and height * height + (far - depth) ** 2 <= left * left
    def inside(self, p):
        """Whether G(p, z) <= U for one of the z that are described there."""
        if self.size and all(dot(minus(p, t), inward) >= 0 for t, inward in zip(self.t, self.inward)):
            return abs(dot(minus(p, self.t[0]), self.normal)) <= self.u * self.size
        return any(self.chord(i, p) or self.folds[i] and self.flap(i, p) for i in range(3))
    def across(self, i, p):
        """Lemma 3 on this side of edge i."""
        height, far, outside, room = self.frame(i, p)
        beyond = self.folds[i][1] * far // SCALE + 1 if outside >= 0 else 0
        return far <= room and height + beyond <= self.u and height * SCALE <= self.u * self.folds[i][2]

def control_cells(proof, units):
    own = {v: Fraction(min(s, FOREVER)) for v, s in proof.sharp_vertices}
    vertices = [Vertex(units(p), own.get(v, 0), proof.warren, lambda: ({}, {})) for v, p in enumerate(proof.control[0])]
    for a, b in proof.border:
        n, i = proof.border[a, b]
        vertices[a].next[vertices[b]] = vertices[proof.control[1][n][i - 1]]
    for a, b, s in proof.sharp_edges + [(a, b, FOREVER) for a, b in proof.border if (b, a) not in proof.border]:
        if s > 0: vertices[a].sharp[vertices[b]] = vertices[b].sharp[vertices[a]] = Fraction(min(s, FOREVER))
    return [tuple(vertices[v] for v in face) for face in proof.control[1]]

def distance(proof, within):
    """What is wrong with the distance (section 3): pairs of a triangle and a condition."""
    scale = Fraction(2) ** (BITS - frexp(max(abs(x) for mesh in (proof.control, proof.result) for p in mesh[0] for x in p))[1])
    units, u, seen = lambda p: tuple(Fraction(x) * scale // 1 for x in p), within * scale // 1 - SLACK, {}
    if u <= 0: yield "-", "U is too small for this checker"
    cells, t = control_cells(proof, units), [units(p) for p in proof.result[0]]
    triangles = [Triangle([t[v] for v in triangle], u) for triangle in proof.result[1]]
    for (a, b), (n, i) in proof.edges.items():
        if (b, a) in proof.edges: triangles[n].join(i, triangles[proof.edges[b, a][0]], proof.edges[b, a][1])
    for n, (parent, corners) in enumerate(zip(proof.parents, proof.result[1])):
        part = [proof.weights(v, parent) for v in corners]
        for v, place in zip(corners, part):
            near = lambda p: dot(minus(p, t[v]), minus(p, t[v])) <= u * u
            if v not in seen: seen[v] = passes(cells[parent], [place], [near])
        if not all(seen[v] for v in corners):
            yield n, "a vertex is too far from its place on the surface"
            continue
        if not passes(cells[parent], part, [triangles[n].inside]): yield n, "inside: the surface over its part is too far from it"
        for i in range(3):
            (a, b), mate = (corners[i], corners[i - 2]), proof.edges.get((corners[i - 2], corners[i]), (n, i))
            tests, folded = [partial(triangles[n].chord, i)], triangles[n].folds[i]
            if folded: tests.append(lambda p: triangles[n].across(i, p) and triangles[mate[0]].across(mate[1], p))
            lines = ((cells[f], [proof.weights(a, f), proof.weights(b, f)]) for f in {parent, proof.parents[mate[0]]})
            if mate >= (n, i) and not any(passes(cell, line, tests) for cell, line in lines): yield n, f"edge {i}: the surface along it is too far from it"

def main(control, result, path, option="--at", length=None):
    try:
        proof = Proof(control, result, path)
        within = Fraction(length) if length else proof.within
        need(option == "--at" and within > 0, "usage: check.py CONTROL RESULT PROOF [--at U], U being positive")
    except Refused as refusal:
        return print(f"refused: {refusal}") or 1
    except Exception as error:  # whatever goes wrong here: the files are not what they should be
        return print(f"unreadable: {type(error).__name__}: {error}") or 2
    failures = list(tiling(proof)) or list(distance(proof, within))
    for n, condition in failures: print(f"triangle {n}: {condition}")
    print(f"refused: {len(failures)} conditions fail" if failures else f"confirmed: {len(proof.parents)} triangles are within {float(within)}")
    return 1 if failures else 0

if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]) if 4 <= len(sys.argv) <= 6 else print(__doc__) or 2)
