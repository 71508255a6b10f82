//! A triangle mesh that can be edited in place: half-edge connectivity with collapses, flips and renamed vertices.
//!
//! It knows no positions. Half-edge `3·face + corner` runs from that corner to the next one, as in
//! [`Topology`]; faces that were collapsed stay in the arrays and are marked dead. These invariants
//! hold at all times: twins are mutual, the faces at a vertex form one fan, and the outgoing
//! half-edge of a boundary vertex is the one without a twin.

use crate::mesh::{NONE, Topology};

#[inline]
pub(super) fn next(h: u32) -> u32 {
    if h % 3 == 2 { h - 2 } else { h + 1 }
}

#[inline]
pub(super) fn previous(h: u32) -> u32 {
    if h.is_multiple_of(3) { h + 2 } else { h - 1 }
}

/// The data of a half-edge.
#[derive(Clone, Copy)]
pub(super) struct Slot {
    origin: u32,
    twin: u32,
    sharp: bool,
}

/// Connectivity that shrinks.
#[derive(Clone)]
pub(super) struct EditableMesh {
    origins: Vec<u32>,
    twins: Vec<u32>,
    outgoing: Vec<u32>,
    sharp: Vec<bool>,
    faces_left: usize,
    /// Whether there is any boundary.
    open: bool,
}

impl EditableMesh {
    /// A copy of `topology` in which no edge is sharp but the boundaries.
    pub(crate) fn new(topology: &Topology) -> Self {
        let twins = topology.raw_twins().to_vec();
        Self {
            origins: topology.triangles().as_flattened().to_vec(),
            sharp: twins.iter().map(|&twin| twin == NONE).collect(),
            open: twins.contains(&NONE),
            twins,
            outgoing: topology
                .vertices()
                .map(|v| topology.outgoing(v).0)
                .collect(),
            faces_left: topology.face_count(),
        }
    }

    /// Number of faces that are left.
    pub(super) fn faces_left(&self) -> usize {
        self.faces_left
    }

    /// Corners of `face`; [`NONE`] in all of them once the face was removed.
    #[inline]
    pub(super) fn corners(&self, face: u32) -> [u32; 3] {
        let first = 3 * face as usize;
        [
            self.origins[first],
            self.origins[first + 1],
            self.origins[first + 2],
        ]
    }

    /// All faces that are left, ascending.
    pub(super) fn faces(&self) -> impl Iterator<Item = u32> + use<'_> {
        (0..(self.origins.len() / 3) as u32).filter(|&face| self.origins[3 * face as usize] != NONE)
    }

    /// Number of places for half-edges, the dead ones included.
    pub(super) fn half_edge_places(&self) -> u32 {
        self.origins.len() as u32
    }

    #[inline]
    pub(super) fn origin(&self, h: u32) -> u32 {
        self.origins[h as usize]
    }

    #[inline]
    pub(super) fn target(&self, h: u32) -> u32 {
        self.origins[next(h) as usize]
    }

    /// The half-edge the other way; [`NONE`] on a boundary.
    #[inline]
    pub(super) fn twin(&self, h: u32) -> u32 {
        self.twins[h as usize]
    }

    /// Whether the edge of `h` is a crease or a boundary.
    #[inline]
    pub(super) fn is_sharp(&self, h: u32) -> bool {
        self.sharp[h as usize]
    }

    /// Marks the edge of `h` as a crease.
    pub(super) fn sharpen(&mut self, h: u32) {
        self.sharp[h as usize] = true;
        let twin = self.twins[h as usize];
        if twin != NONE {
            self.sharp[twin as usize] = true;
        }
    }

    /// Whether the vertex is still there.
    #[inline]
    pub(super) fn is_alive(&self, vertex: u32) -> bool {
        self.outgoing[vertex as usize] != NONE
    }

    #[inline]
    pub(super) fn is_boundary(&self, vertex: u32) -> bool {
        self.twins[self.outgoing[vertex as usize] as usize] == NONE
    }

    /// Outgoing half-edges counter-clockwise, one for each face.
    #[inline]
    pub(super) fn outgoing_ring(&self, vertex: u32) -> impl Iterator<Item = u32> + use<'_> {
        let first = self.outgoing[vertex as usize];
        core::iter::successors(Some(first), move |&h| {
            let turned = self.twins[previous(h) as usize];
            (turned != NONE && turned != first).then_some(turned)
        })
    }

    /// Calls `f` for each neighbour of a vertex, counter-clockwise.
    #[inline]
    pub(super) fn for_each_neighbour(&self, vertex: u32, mut f: impl FnMut(u32)) {
        let mut last = NONE;
        for h in self.outgoing_ring(vertex) {
            f(self.target(h));
            last = h;
        }
        let before = previous(last);
        if self.twins[before as usize] == NONE {
            f(self.origins[before as usize]);
        }
    }

    /// Whether there is an edge between two vertices.
    pub(super) fn are_neighbours(&self, a: u32, b: u32) -> bool {
        self.outgoing_ring(a)
            .any(|h| self.target(h) == b || self.origins[previous(h) as usize] == b)
    }

    /// Whether the edge of `h` can be collapsed, its end `from` into the other, and the result is a manifold of the same
    /// kind (the link condition of Dey, Edelsbrunner, Guha and Nekhayev 1999): the ends share no neighbours but those
    /// opposite the edge, an inner edge does not join two boundary vertices, and those opposite keep a face.
    pub(super) fn can_collapse(&self, h: u32, from: u32) -> bool {
        let into = if self.origin(h) == from {
            self.target(h)
        } else {
            self.origin(h)
        };
        let twin = self.twin(h);
        if twin != NONE && self.is_boundary(from) {
            return false;
        }
        // A triangle alone, and a tetrahedron, whose last two faces would be one.
        let is_ear = |h: u32| self.twin(next(h)) == NONE && self.twin(previous(h)) == NONE;
        if is_ear(h) || (twin != NONE && is_ear(twin)) {
            return false;
        }
        let mut shared = 0;
        let mut around = 0;
        self.for_each_neighbour(from, |v| {
            around += 1;
            shared += usize::from(v != into && self.are_neighbours(v, into));
        });
        let is_tetrahedron =
            || around == 3 && twin != NONE && self.outgoing_ring(into).take(4).count() == 3;
        shared == 1 + usize::from(twin != NONE) && !is_tetrahedron()
    }

    /// Collapses the edge of `h`: its end `from` goes, and its faces now meet at the other. The
    /// caller has checked [`Self::can_collapse`].
    pub(super) fn collapse(&mut self, h: u32, from: u32) {
        let into = if self.origin(h) == from {
            self.target(h)
        } else {
            self.origin(h)
        };
        let twin = self.twin(h);
        self.rename_fan(from, into);
        self.outgoing[from as usize] = NONE;
        // The outgoing half-edges are known once both faces were removed.
        let mut seats = [(NONE, NONE); 4];
        [seats[0], seats[1]] = self.close(h, into);
        if twin != NONE {
            [seats[2], seats[3]] = self.close(twin, into);
        }
        for (vertex, seat) in seats {
            // A half-edge that the first face left open may have gone with the second.
            if vertex != NONE && self.origins[seat as usize] == vertex {
                self.seat(vertex, seat);
            }
        }
    }

    /// Takes out the face of `h`, whose ends have become the vertex `merged`, and joins its two neighbours. Gives its two
    /// corners, each with a half-edge that leaves it.
    fn close(&mut self, h: u32, merged: u32) -> [(u32, u32); 2] {
        // Of the two half-edges outside one leaves the corner next to the merged ones and one
        // reaches it.
        let other = self.origins[previous(h) as usize];
        let [leaving, reaching] = [next(h), previous(h)].map(|side| self.twins[side as usize]);
        let sharp = self.sharp[next(h) as usize] || self.sharp[previous(h) as usize];
        for (side, across) in [(leaving, reaching), (reaching, leaving)] {
            if side != NONE {
                self.twins[side as usize] = across;
                self.sharp[side as usize] = sharp;
            }
        }
        let first = h - h % 3;
        for dead in first..first + 3 {
            self.origins[dead as usize] = NONE;
            self.twins[dead as usize] = NONE;
        }
        self.faces_left -= 1;
        let leaves_other = if leaving != NONE {
            leaving
        } else {
            next(reaching)
        };
        let leaves_merged = if reaching != NONE {
            reaching
        } else {
            next(leaving)
        };
        [(other, leaves_other), (merged, leaves_merged)]
    }

    /// Makes `h`, or the boundary half-edge reached from it turning clockwise, the outgoing one of `vertex`.
    fn seat(&mut self, vertex: u32, h: u32) {
        let mut first = h;
        if self.open {
            while self.twins[first as usize] != NONE {
                first = next(self.twins[first as usize]);
                if first == h {
                    break;
                }
            }
        }
        self.outgoing[vertex as usize] = first;
    }

    /// The data of the half-edge `h`, to be [`Self::put`] back.
    pub(crate) fn slot(&self, h: u32) -> Slot {
        let at = h as usize;
        Slot {
            origin: self.origins[at],
            twin: self.twins[at],
            sharp: self.sharp[at],
        }
    }

    /// Restores the half-edge `h`.
    pub(super) fn put(&mut self, h: u32, slot: Slot) {
        let at = h as usize;
        // A face that was gone is back.
        self.faces_left += usize::from(h.is_multiple_of(3) && self.origins[at] == NONE);
        (self.origins[at], self.twins[at], self.sharp[at]) = (slot.origin, slot.twin, slot.sharp);
    }

    /// Lets the corners of a face that was put back know of it. All around it has been put back, too.
    pub(super) fn seat_corners(&mut self, face: u32) {
        for h in 3 * face..3 * face + 3 {
            self.seat(self.origins[h as usize], h);
        }
    }

    fn rename_fan(&mut self, from: u32, into: u32) {
        let first = self.outgoing[from as usize];
        let mut at = first;
        loop {
            self.origins[at as usize] = into;
            at = self.twins[previous(at) as usize];
            if at == NONE || at == first {
                break;
            }
        }
    }

    /// Turns the edge of `h`, which has faces on both sides, into the other diagonal of its quadrilateral. The caller
    /// has made sure that no such edge exists.
    pub(super) fn flip(&mut self, h: u32) {
        let t = self.twin(h);
        let (n, p, tn, tp) = (next(h), previous(h), next(t), previous(t));
        let [a, b, c, d] = [h, n, p, tp].map(|h| self.origins[h as usize]);
        let outside = [n, p, tn, tp].map(|h| (self.twins[h as usize], self.sharp[h as usize]));
        for (slot, origin) in [(h, c), (n, d), (p, b), (t, d), (tn, c), (tp, a)] {
            self.origins[slot as usize] = origin;
        }
        let [beyond_n, beyond_p, beyond_tn, beyond_tp] = outside;
        for (slot, (across, sharp)) in [
            (n, beyond_tp),
            (p, beyond_n),
            (tn, beyond_p),
            (tp, beyond_tn),
        ] {
            self.twins[slot as usize] = across;
            self.sharp[slot as usize] = sharp;
            if across != NONE {
                self.twins[across as usize] = slot;
            }
        }
        for (vertex, slot) in [(a, tp), (b, p), (c, h), (d, n)] {
            self.seat(vertex, slot);
        }
    }
}
