"""A second, slow and short checker of proofs, written from docs/certificate.md alone. Names and numbers of sections are those of that page.

    check.py CONTROL RESULT PROOF [--at U]

CONTROL may be - if the proof holds the control mesh; --at U takes the place of the length in the proof. Reads OFF, OBJ and PLY. Exit status: 0 confirmed,
1 refused (each line names a triangle, counted from 0, and the condition that fails), 2 unreadable.

All decisions are made in integers. A coordinate is a whole number of units, one unit being 2^-70 of a power of two above m. Each operation rounds down,
so it adds less than one unit to the error of a coordinate, and takes convex combinations of what it is given: vertices of M 1; each of 40 levels 3 (the
rule, beta, the mixture), so 121; Bezier points of mirrored control points 3 * 121 + 1; a sub-triangle 4: 368 in all, in space 368 * sqrt(3) < 638.
Vertices of K: less than 2. U is lowered by SLACK = 1024 units for all of it. Lengths, tangents and sines are bounded on the safe side.

What the page leaves to choose: flaps are a little smaller than they may be (tan 80 degrees is taken as 5, roots are rounded down). The witness z for a
point is its foot if that is in T, else the nearest point of T's border, or the foot moved straight towards an edge until it is in the flap there. At
irregular corners control points are the hull, level after level, also for vertices of K: there are no limits and no cones."""
import hashlib, io, re, struct, sys
from fractions import Fraction
from functools import cached_property, lru_cache, partial
from math import frexp, gcd, isfinite, isqrt
BITS, SLACK, DEPTH, FOREVER = 70, 1024, 40, 10  # FOREVER: a sharpness that never fades
SCALE, PLACE = 1 << 100, 1 << 30  # what counts as 1: for tangents, sines and cosines, and for the weights of places
HEADER = re.compile(rb"limitmesh proof 1\nscheme (loop|loop-warren)\nwithin ([0-9.eE+-]+)\ncontrol ([0-9a-f]{64})\nresult ([0-9a-f]{64})\nend\n")
PLY_TYPES = dict(zip("char int8 uchar uint8 short int16 ushort uint16 int int32 uint uint32 float float32 double float64".split(), "bbBBhhHHiiIIffdd"))

class Refused(Exception): pass
def need(condition, text, error=ValueError):
    if not condition: raise error(text)
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
    elements, stream, words = [], io.BytesIO(body), iter(body.split())
    for key, *rest in (line.split() for line in head.decode("utf-8", "replace").splitlines()):
        if key == "format": ascii = {"ascii": True, "binary_little_endian": False}[rest[0]]
        if key == "element": elements.append((rest[0], int(rest[1]), []))
        if key == "property": elements[-1][2].append((rest[-1], [PLY_TYPES[kind] for kind in rest[:-1] if kind != "list"]))
    read = lambda kind: (float if kind in "fd" else int)(next(words) if ascii else struct.unpack("<" + kind, stream.read(struct.calcsize(kind)))[0])
    value = lambda kinds: tuple([read(kinds[1]) for _ in range(read(kinds[0]))]) if kinds[1:] else read(kinds[0])
    rows = {element: [{name: value(kinds) for name, kinds in properties} for _ in range(count)] for element, count, properties in elements}
    return [tuple(float(row[x]) for x in "xyz") for row in rows["vertex"]], [row.get("vertex_indices") or row["vertex_index"] for row in rows["face"]]
def checked(points, faces, digest, name):
    need(all(len(p) == 3 and all(map(isfinite, p)) for p in points), f"the {name} mesh has vertices that are no points")
    need(all(len(face) == 3 and 0 <= min(face) <= max(face) < len(points) for face in faces), f"the {name} mesh has faces that are no triangles")
    flat = [x + 0.0 for p in points for x in p] + [v for face in faces for v in face]  # -0.0 + 0.0 is 0.0
    data = struct.pack(f"<II{3 * len(points)}d{3 * len(faces)}I", len(points), len(faces), *flat)
    need(name == "result" or hashlib.sha256(data).hexdigest() == digest.decode(), f"the {name} mesh or its hash is not that of the proof", Refused)
    return points, faces
def directed_edges(faces): return {(face[i], face[i - 2]): (n, i) for n, face in enumerate(faces) for i in range(3)}

class Proof:  # the three files (section 7); a place is a control face, with the weights of its corners that are not 0, by the names of the corners
    def __init__(self, control, result, proof):
        with open(proof, "rb") as file: data = file.read()
        match = HEADER.match(data)
        need(match, "this is no proof of version 1")
        self.stream, self.warren, self.within = io.BytesIO(data[match.end():]), match[1] == b"loop-warren", Fraction(match[2].decode())
        meshes, n, m = [read_mesh(control)] if control != "-" else [], self.varint(), self.varint()
        if n or m: meshes.append([[flat[i:i + 3] for i in range(0, len(flat), 3)] for flat in (self.take(f"<{3 * n}d"), self.take(f"<{3 * m}I"))])
        need(meshes, "the control mesh is in a file of its own")
        self.control, self.result = [checked(*mesh, match[3], "control") for mesh in meshes][0], checked(*read_mesh(result), match[4], "result")
        self.border, self.edges = directed_edges(self.control[1]), directed_edges(self.result[1])
        self.sharp_edges = [(self.varint(), self.varint(), *self.take("<d")) for _ in range(self.varint())]
        self.sharp_vertices = [(self.varint(), *self.take("<d")) for _ in range(self.varint())]
        need(all(s >= 0 for *_, s in self.sharp_edges + self.sharp_vertices), "a sharpness is negative, or no number")
        need(all({(a, b), (b, a)} & self.border.keys() for a, b, _ in self.sharp_edges), "a sharp edge is no edge of the control mesh")
        self.parents, self.places, face = [], {}, 0
        while len(self.parents) < len(self.result[1]):
            n = self.varint()
            faces = self.varint() if n % 2 else 1
            need(faces * (n // 2) <= len(self.result[1]) - len(self.parents) and face + faces <= len(self.control[1]), "the parents make no sense")
            self.parents, face = self.parents + [face + i for i in range(faces) for _ in range(n // 2)], face + faces
        for n, (parent, triangle) in enumerate(zip(self.parents, self.result[1])):
            for i, v in enumerate(triangle):
                if v not in self.places: self.places[v] = parent, self.read_place(parent, triangle[i - 2], triangle[i - 1])
            need(all(self.weights(v, parent) for v in triangle), f"triangle {n}: its parent does not hold the places of its corners", Refused)
        need(not self.stream.read(), "the proof goes on after its end")
    def take(self, form): return struct.unpack(form, self.stream.read(struct.calcsize(form)))
    def varint(self):
        byte, = self.take("B")
        return byte if byte < 128 else byte - 128 + (self.varint() << 7)
    def read_place(self, parent, a, b):
        c, = self.take("B")
        if c < 153: i, j = [(i * PLACE // 16, j * PLACE // 16) for i in range(17) for j in range(17 - i)][c]
        elif c < 159:
            (_, ai, aj), (_, bi, bj) = self.weights(a, parent), self.weights(b, parent)
            p, q = ((0, 6), (3, 3), (0, 12), (4, 4), (2, 2), (0, 3))[c - 153]
            i, j = Fraction(p * (bi - ai) - q * (bj - aj), 6) + ai, Fraction(p * (bj - aj) + q * (bi - ai + bj - aj), 6) + aj
        else:
            (e,), i, j = self.take("B"), self.varint(), self.varint()
            need(c == 255 and e <= 30, "the code of a place is unknown")
            i, j = i << 30 - e, j << 30 - e
        need(i >= 0 and j >= 0 and i + j <= PLACE and i == int(i) and j == int(j), "a place is outside of its parent, or no multiple of 2^-30")
        return {v: w for v, w in zip(self.control[1][parent], (PLACE - int(i) - int(j), int(i), int(j))) if w}
    def weights(self, v, face):  # the weights of the place of v in a face, or None if the face does not hold it
        home, named = self.places[v]
        weights = tuple(named.get(name, 0) for name in self.control[1][face])
        return weights if sum(weights) == PLACE and (len(named) < 3 or home == face) else None

def area(part): return (part[1][1] - part[0][1]) * (part[2][2] - part[0][2]) - (part[2][1] - part[0][1]) * (part[1][2] - part[0][2])
def tiling(proof):  # what is wrong with the tiling (section 1): pairs of a triangle and a condition
    border, edges, areas = proof.border, proof.edges, [0] * len(proof.control[1])
    if len(border) < 3 * len(areas) or any(a == b for a, b in border): yield "-", "a directed edge of the control mesh occurs twice"
    for n, (parent, triangle) in enumerate(zip(proof.parents, proof.result[1])):
        part = [proof.weights(v, parent) for v in triangle]
        areas[parent] += area(part)
        if area(part) < 0 or len(set(part)) < 3: yield n, "its part has a negative area, or less than three corners"
        for i in range(3):
            a, b, names = triangle[i], triangle[i - 2], tuple(proof.places[triangle[i]][1] | proof.places[triangle[i - 2]][1])
            if edges[a, b] != (n, i): yield n, f"edge {i} occurs twice in the same direction"
            elif (b, a) not in edges and not (len(names) == 2 and (names in border) != (names[::-1] in border)):
                yield n, f"edge {i} has one triangle only, and is not on such an edge of the control mesh"
            elif (b, a) in edges and len(names) > 2 and proof.parents[edges[b, a][0]] != parent:
                yield n, f"edge {i} is inside of its parent, but its other triangle has another parent"
    for f in (f for f in range(len(areas)) if areas[f] != PLACE * PLACE):
        yield proof.parents.index(f) if f in proof.parents else "-", f"the areas of the parts in its parent, control face {f}, do not add up"

@lru_cache(None)
def beta(k, warren):  # times 2^128, off by less than 2: less than 300 terms are rounded at 2^-160, and the alternating series leave out less than that
    one, term, cosine = 1 << 160, 1 << 160, 0
    if warren: return (3 << 128) // (16 if k == 3 else 8 * k)
    arctan = lambda n: sum((-1) ** i * (one // ((2 * i + 1) * n ** (2 * i + 1))) for i in range(80))
    angle = 2 * (16 * arctan(5) - 4 * arctan(239)) // k
    for i in range(0, 120, 2): cosine, term = cosine + term, -term * angle * angle // (one * one * (i + 1) * (i + 2))
    return (5 * one // 8 - (3 * one // 8 + cosine // 4) ** 2 // one) // k >> 32
def fade(s): return s if s >= FOREVER else max(0, s - 1)
def minus(p, q): return p[0] - q[0], p[1] - q[1], p[2] - q[2]
def dot(p, q): return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
def cross(p, q): return p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]
def combine(divisor, *terms): return tuple([sum([w * p[i] for w, p in terms]) // divisor for i in range(3)])
def mixture(w, p, q): return combine(w.denominator, (w.numerator, p), (w.denominator - w.numerator, q))

class Vertex:  # a control point (section 5); around() is: the neighbours, each with the one after it; and the sharpness of sharp edges, by neighbour
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
    def half(self, other):  # the new vertex on the edge to another one
        if other not in self.halves:
            a, b, s = self, other, self.sharp.get(other, 0)
            sides = [(a, b, a.next.get(b)), (b, a, next((n for n in a.next if a.next[n] is b), None))]
            p = combine(2, (1, a.p), (1, b.p))
            if s < 1: p = mixture(Fraction(s), p, combine(8, (3, a.p), (3, b.p), *((1, c.p) for _, _, c in sides)))
            around = lambda: (dict(pair for a, b, c in sides if c for pair in ((b.child, b.half(c)), (b.half(c), a.half(c)), (a.half(c), a.child))),
                              {end.child: fade(s) for end in (a, b) if fade(s)})
            a.halves[b] = b.halves[a] = Vertex(p, 0, a.warren, around)
        return self.halves[other]
    def six(self, n):  # the six points around a regular vertex from n on, mirrored beyond a lasting crease, or None
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
@lru_cache(None)
def bezier_net(cell):  # rows of Bezier points, net[k][j] having the exponents (4 - j - k, j, k), or None for an irregular cell; a cell is its three corners
    net, sixes = [[None] * (5 - k) for k in range(5)], [v.six(cell[i - 2]) for i, v in enumerate(cell)]
    for i, (exponents, weights) in ((i, stencil) for i in range(3) for stencil in STENCILS if None not in sixes):
        net[exponents[2 - i]][exponents[1 - i]] = combine(24, *zip(weights, (cell[i].p, *sixes[i])))
    return net if None not in sixes else None
def children(cell):  # the four cells of the next level, each with the map of weights to its own
    (a, b, c), (ab, bc, ca) = cell, (v.half(cell[i - 2]) for i, v in enumerate(cell))
    return (((a.child, ab, ca), lambda x, y, z: (x - y - z, 2 * y, 2 * z)), ((ab, b.child, bc), lambda x, y, z: (2 * x, y - z - x, 2 * z)),
            ((ca, bc, c.child), lambda x, y, z: (2 * x, 2 * y, z - x - y)), ((bc, ca, ab), lambda x, y, z: (y + z - x, z + x - y, x + y - z)))

def between(p, w, q, v):  # a point of the line pq; points are given by whole weights, and the sum of those of a point counts as 1
    point = [w * x + v * y for x, y in zip(p, q)]
    return tuple([x // gcd(*point) for x in point])
def clip(polygon):  # the part of a convex polygon, line or point where no weight is negative
    for i in range(3):
        points = [r for p, q in zip(polygon, polygon[1:] + polygon[:1]) for r in ([p, between(p, abs(q[i]), q, abs(p[i]))] if p[i] * q[i] < 0 else [p])]
        polygon = list(dict.fromkeys(between(p, 1, p, 0) for p in points if p[i] >= 0))
    return polygon
def split(polygon):
    if len(polygon) > 3: return [[polygon[0], *side] for side in zip(polygon[1:], polygon[2:])]
    (a, b, *c), middle = polygon, between(polygon[0], sum(polygon[1]), polygon[1], sum(polygon[0]))
    return [c + [a, middle], [b] + c + [middle]]
def casteljau(net, weights):
    (a, b, c), one = weights, sum(weights)
    return [[tuple([(a * x + b * y + c * z) // one for x, y, z in zip(p, q, r)]) for p, q, r in zip(row, row[1:], up)] for row, up in zip(net, net[1:])]
def bezier_points(net, corners):  # those over a triangle, line or point with these corners
    return net[0] if len(net) == 1 else [p for i, corner in enumerate(corners) for p in bezier_points(casteljau(net, corner), corners[i:])]
def passes(cell, polygon, tests, depth=DEPTH):  # whether the surface over a polygon divides into pieces such that all points of the hull of each pass a test
    net = bezier_net(cell)
    if not net or len(polygon) <= 3:
        points = bezier_points(net, polygon) if net else {n.p for v in cell for n in (v, *v.ring)}
        if any(all(map(test, points)) for test in tests): return True
        ends = [bezier_points(net, [p])[0] for p in polygon] if net else []  # points of the surface, so points of each hull that holds them
        if depth == 0 or not all(any(test(p) for test in tests) for p in ends): return False
    pieces = [(cell, piece) for piece in split(polygon)] if net else [(child, clip([to_child(*p) for p in polygon])) for child, to_child in children(cell)]
    pieces = [(child, piece) for child, piece in pieces if len(piece) >= min(len(polygon), 3)]
    return all(passes(child, piece, tests, depth - 1) for child, piece in (pieces if len(polygon) > 1 else pieces[:1]))

class Triangle:  # a triangle of K (section 2); the lengths of its normal and edges are rounded down, so plus 1 they are rounded up
    def __init__(self, corners, u):
        self.t, self.u, self.folds, self.e = corners, u, [None] * 3, [minus(corners[i - 2], corners[i]) for i in range(3)]
        self.normal = cross(self.e[0], self.e[1])
        self.inward, self.squares = [cross(self.normal, e) for e in self.e], [dot(e, e) or 1 for e in self.e]
        self.size, self.sizes = isqrt(dot(self.normal, self.normal)), [isqrt(square) for square in self.squares]
    def bases(self, i, j, other):  # the tangents of the flap's base angles at the ends of edge i, corner j of the other triangle being at the first one
        least = []
        for k, l in ((i, j % 3), (i - 2, (j + 2) % 3)):
            product, far = -dot(self.e[k], self.e[k - 1]), -dot(other.e[l], other.e[l - 1])
            half = (isqrt(self.squares[k] * self.squares[k - 1]) + product) * SCALE // (self.size + 1)
            least.append(max(0, min(5 * SCALE, half, other.size * SCALE // far if far > 0 else half)))
        return least
    def join(self, i, other, j):  # notes the tangents for both parts of the lens, sigma and cos(theta / 2), if the edge is joined
        cosine = dot(self.normal, other.normal) * SCALE // ((self.size + 1) * (other.size + 1))
        if self.size and other.size and cosine > 0:
            lens = self.bases(i, j - 2, other), other.bases(j, i - 2, self)[::-1]
            self.folds[i] = lens, isqrt(2 * SCALE * (SCALE - cosine)) + 1, isqrt(SCALE * (SCALE + cosine) // 2)
    def chord(self, i, p):  # whether p is within U of edge i
        d, square = minus(p, self.t[i]), self.squares[i]
        along = dot(d, self.e[i])
        return dot(d, d) * square + min(max(along, 0), square) * (min(max(along, 0), square) - 2 * along) <= self.u * self.u * square
    def frame(self, i, p):  # |h|; |g| of Lemma 3, rounded up; g rounded down, negative inside; how far the lens extends there
        d, size, square = minus(p, self.t[i]), self.sizes[i], self.squares[i]
        inside, along = dot(d, self.inward[i]), dot(d, self.e[i])
        first, second = self.folds[i][0][inside > 0]
        room = min(along * first, (square - along) * second) // ((size + 1) * SCALE)
        return abs(dot(d, self.normal)) // self.size + 1, abs(inside) // (self.size * size) + 1, -inside // ((self.size + 1) * (size + 1)), room
    def flap(self, i, p):  # whether G(p, z) <= U for the z in the flap that is described at the top of this file
        height, far, outside, room = self.frame(i, p)
        depth = min(outside, room)
        left = self.u - self.folds[i][1] * depth // SCALE - 1
        return depth > 0 <= left and height * height + (far - depth) ** 2 <= left * left
    def inside(self, p):  # whether G(p, z) <= U for one of the z that are described there
        if self.size and all(dot(minus(p, t), inward) >= 0 for t, inward in zip(self.t, self.inward)):
            return abs(dot(minus(p, self.t[0]), self.normal)) <= self.u * self.size
        return any(self.chord(i, p) or self.folds[i] and self.flap(i, p) for i in range(3))
    def across(self, i, p):  # Lemma 3 on this side of edge i
        height, far, outside, room = self.frame(i, p)
        turned = height + (self.folds[i][1] * far // SCALE + 1) * (outside >= 0)
        return far <= room and turned <= self.u and height * SCALE <= self.u * self.folds[i][2]

def control_cells(proof, units):
    (points, faces), border, own, at = proof.control, proof.border, {v: Fraction(min(s, FOREVER)) for v, s in proof.sharp_vertices}, {}
    for n, v in ((n, v) for n, face in enumerate(faces) for v in face):  # at[n, v] is the corner of face n at v: a vertex for each fan of faces
        vertex, fan = Vertex(units(points[v]), own.get(v, 0), proof.warren, lambda: ({}, {})), [] if (n, v) in at else [n]
        while fan:
            at[f := fan.pop(), v] = vertex
            fan += [border[edge][0] for w in faces[f] for edge in ((v, w), (w, v)) if edge in border and (border[edge][0], v) not in at]
    for (a, b), (n, i) in border.items(): at[n, a].next[at[n, b]] = at[n, faces[n][i - 1]]
    for a, b, s in proof.sharp_edges + [(a, b, FOREVER) for a, b in border if (b, a) not in border]:
        n, _ = border.get((a, b)) or border[b, a]
        if s > 0: at[n, a].sharp[at[n, b]] = at[n, b].sharp[at[n, a]] = Fraction(min(s, FOREVER))
    return [tuple(at[n, v] for v in face) for n, face in enumerate(faces)]
def distance(proof, within):  # what is wrong with the distance (section 3): pairs of a triangle and a condition
    scale = Fraction(2) ** (BITS - frexp(max(abs(x) for mesh in (proof.control, proof.result) for p in mesh[0] for x in p))[1])
    units, u, parents = lambda p: tuple(Fraction(x) * scale // 1 for x in p), within * scale // 1 - SLACK, proof.parents
    if u <= 0: yield "-", "U is too small for this checker"
    cells, t, near = control_cells(proof, units), [units(p) for p in proof.result[0]], lambda q, p: dot(minus(p, q), minus(p, q)) <= u * u
    sheets = {(v, frozenset(c for c, w in zip(cells[f], proof.weights(v, f)) if w)): f for f, corners in zip(parents, proof.result[1]) for v in corners}
    bad = {v for (v, _), f in sheets.items() if not passes(cells[f], [proof.weights(v, f)], [partial(near, t[v])])}
    triangles = [Triangle([t[v] for v in corners], u) for corners in proof.result[1]]
    mates = {here: proof.edges.get((b, a), here) for (a, b), here in proof.edges.items()}
    for (n, i), (m, j) in mates.items(): m == n or triangles[n].join(i, triangles[m], j)
    for n, corners in enumerate(proof.result[1]):
        cell, part = cells[parents[n]], [proof.weights(v, parents[n]) for v in corners]
        pieces = [part] if area(part) else [part[:2], part[1:], part[::2]]  # the sides of a part that is a line
        if bad & set(corners): yield n, "a vertex is too far from its place on the surface"
        elif not all(passes(cell, piece, [triangles[n].inside]) for piece in pieces): yield n, "inside: the surface over its part is too far from it"
        for i, (m, j) in ((i, mates[n, i]) for i in range(3) if mates[n, i] <= (n, i) and not bad & {corners[i], corners[i - 2]}):
            tests = [partial(triangles[n].chord, i), lambda p: triangles[n].folds[i] and triangles[n].across(i, p) and triangles[m].across(j, p)]
            lines = ((cells[f], [proof.weights(corners[i], f), proof.weights(corners[i - 2], f)]) for f in dict.fromkeys((parents[n], parents[m])))
            if not any(passes(cell, line, tests) for cell, line in lines): yield n, f"edge {i}: the surface along it is too far from it"

def main(control, result, path, length=None):
    try:
        proof = Proof(control, result, path)
        failures = list(tiling(proof)) or list(distance(proof, Fraction(length or proof.within)))
    except Refused as refusal: failures = [("-", refusal)]
    except Exception as error: return print(f"unreadable: {error!r}") or 2  # whatever goes wrong: the files are not what they should be
    for n, condition in failures: print(f"triangle {n}: {condition}")
    return print(f"refused: {len(failures)} conditions fail" if failures else f"confirmed: all {len(proof.parents)} triangles") or min(1, len(failures))
if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:4], *sys.argv[5:]) if len(sys.argv) == 4 or len(sys.argv) == 6 and sys.argv[4] == "--at" else print(__doc__) or 2)
