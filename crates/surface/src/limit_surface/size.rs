//! Area and volume of the limit surface.
//!
//! By the divergence theorem the volume is ⅓ ∮ S·(S_u × S_v) du dv. On a regular piece that is a
//! polynomial of degree 10, which a product of Gauss rules with six nodes integrates exactly, or of degree 16 over half a quad, for which
//! it takes ten; the area's integrand |S_u × S_v| is none, and pieces are divided until two rules agree. Towards
//! irregular vertices pieces are refined down to a speck, which a flat triangle approximates.

use super::LimitSurface;
use crate::index::FaceId;
use crate::parallel;
use crate::patch::polynomial::{Polynomial, RegularPiece as _};
use crate::patch::{ParamTriangle, Patch, child_corners, root_patch};
use crate::vector::{DVec3, vector};

/// Faces that are integrated together.
const BLOCK: usize = 64;

/// Pieces are refined until their triangle is this part of the face's. Near an irregular vertex
/// they are flat then, but their edges are bent at every size, so that the triangle's own error is
/// some tenths of it.
const SPECK: f64 = 1e-12;

/// Refinements at most, where pieces do not get smaller.
const DEEPEST: u32 = 64;

/// Two rules agree if they differ by less than this part of the face's area.
const AGREEMENT: f64 = 1e-10;

/// Times that a piece is divided at most, where the surface has a cusp.
const MOST_DIVISIONS: u32 = 6;

/// Nodes and weights of Gauss's rule on −1 to 1, the positive ones (Abramowitz and Stegun, table 25.4).
const TEN: [(f64, f64); 5] = [
    (0.148_874_338_981_631_2, 0.295_524_224_714_752_9),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_35),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];
const SIX: [(f64, f64); 3] = [
    (0.238_619_186_083_196_9, 0.467_913_934_572_691),
    (0.661_209_386_466_264_5, 0.360_761_573_048_138_6),
    (0.932_469_514_203_152, 0.171_324_492_379_170_4),
];
const FOUR: [(f64, f64); 2] = [
    (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
];

/// The integrand: its value over a regular piece, given the area of its face, and over the flat
/// triangle that approximates a speck.
trait Integrand: Sync {
    fn of_piece(&self, piece: &Polynomial, whole: f64) -> f64;
    fn of_triangle(&self, corners: [DVec3; 3]) -> f64;
}

struct Area;

/// The volume between a surface and the origin.
struct Volume;

impl Integrand for Area {
    fn of_piece(&self, piece: &Polynomial, whole: f64) -> f64 {
        area(
            piece,
            ParamTriangle::WHOLE,
            AGREEMENT * whole,
            MOST_DIVISIONS,
        )
    }

    fn of_triangle(&self, [a, b, c]: [DVec3; 3]) -> f64 {
        0.5 * (b - a).cross(c - a).length()
    }
}

impl Integrand for Volume {
    fn of_piece(&self, piece: &Polynomial, _: f64) -> f64 {
        let rule: &[_] = match piece {
            Polynomial::Quartic(_) => &SIX,
            Polynomial::Bicubic(_) => &TEN,
        };
        integral(rule, ParamTriangle::WHOLE, |u, v| {
            let [by_u, by_v] = piece.tangents(u, v);
            piece.point(u, v).dot(by_u.cross(by_v)) / 3.0
        })
    }

    fn of_triangle(&self, [a, b, c]: [DVec3; 3]) -> f64 {
        a.dot((b - a).cross(c - a)) / 6.0
    }
}

impl LimitSurface<'_> {
    /// The area, to some 1e-9 of it where the surface has no cusps, in squares of the control
    /// mesh's unit; `None` for schemes but the Loop family and Catmull–Clark, and where it overflows.
    pub fn area(&self) -> Option<f64> {
        self.integrated(&Area, 2)
    }

    /// The volume that a closed surface encloses, to some 1e-11 of it, in cubes of the control
    /// mesh's unit: below 0 where normals point inwards. `None` for surfaces with a boundary, for
    /// schemes but the Loop family and Catmull–Clark, and where it overflows.
    ///
    /// ```
    /// use limitmesh_surface::{LimitSurface, Mesh, scheme::Loop};
    ///
    /// let mesh = Mesh::from_triangles(
    ///     vec![[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]],
    ///     vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
    /// )?;
    /// let volume = LimitSurface::new(&mesh, &Loop)?.volume().ok_or("an open surface")?;
    /// assert!((volume - 0.1029931143).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn volume(&self) -> Option<f64> {
        let topology = self.mesh.topology();
        if topology.half_edges().any(|h| topology.twin(h).is_none()) {
            return None;
        }
        self.integrated(&Volume, 3)
    }

    /// The sum over all faces, of an integrand that grows with that power of lengths.
    fn integrated(&self, integrand: &impl Integrand, power: usize) -> Option<f64> {
        if !self.is_certified() {
            return None;
        }
        // Seen from its middle, and about as large as 1, a surface keeps its digits at any position
        // and size.
        let [low, high] = self
            .mesh
            .as_triangles()
            .bounding_box()?
            .map(|corner| 0.5 * vector(corner));
        let (middle, size) = (low + high, (high - low).max_element());
        let size = if size > 0.0 { size } else { 1.0 };
        let positions = self
            .mesh
            .positions()
            .iter()
            .map(|&p| ((vector(p) - middle) / size).to_array())
            .collect();
        let mesh = self.mesh.clone().with_positions(positions).ok()?;
        let surface = LimitSurface::without_normals(&mesh, self.rules.scheme()).ok()?;
        let blocks = parallel::pieces_of(mesh.face_count(), BLOCK, |block| {
            block
                .map(|face| surface.integrated_over(FaceId(face as u32), integrand))
                .sum::<f64>()
        });
        let sum: f64 = blocks.into_iter().sum();
        Some((0..power).fold(sum, |sum, _| sum * size)).filter(|sum| sum.is_finite())
    }

    fn integrated_over(&self, face: FaceId, integrand: &impl Integrand) -> f64 {
        let corners =
            self.mesh.triangles()[face.index()].map(|v| vector(self.positions[v as usize]));
        let patch = root_patch(self.mesh, &self.sharpness, &self.large, face, &self.rules);
        self.integrated_over_piece(
            &patch,
            corners,
            (integrand, Area.of_triangle(corners)),
            DEEPEST,
        )
    }

    /// Over a piece, given its corners and the area of its face.
    fn integrated_over_piece<I: Integrand>(
        &self,
        patch: &Patch,
        corners: [DVec3; 3],
        (integrand, whole): (&I, f64),
        levels: u32,
    ) -> f64 {
        if let Some(polynomial) = Polynomial::of(patch) {
            return integrand.of_piece(&polynomial, whole);
        }
        if Area.of_triangle(corners) <= SPECK * whole || levels == 0 {
            return integrand.of_triangle(corners);
        }
        let refined = patch.refined(&self.rules);
        let middles = [0, 1, 2].map(|edge| refined.middle_as::<DVec3>(edge));
        let of_part = |part| match refined.points(part) {
            Some(points) => integrand.of_piece(&points.polynomial(&points.net()), whole),
            None => {
                let corners = child_corners(corners, middles, part);
                self.integrated_over_piece(
                    &refined.part(part),
                    corners,
                    (integrand, whole),
                    levels - 1,
                )
            }
        };
        (0..4).map(of_part).sum()
    }
}

fn area(piece: &Polynomial, domain: ParamTriangle, agreement: f64, divisions: u32) -> f64 {
    let density = |u: f64, v: f64| {
        let [by_u, by_v] = piece.tangents(u, v);
        by_u.cross(by_v).length()
    };
    let (coarse, fine) = (
        integral(&FOUR, domain, density),
        integral(&SIX, domain, density),
    );
    if (coarse - fine).abs() <= agreement || divisions == 0 {
        return fine;
    }
    (0..4)
        .map(|child| area(piece, domain.child(child), 0.25 * agreement, divisions - 1))
        .sum()
}

/// The integral over a part, by a product of rules on the square that is collapsed to the triangle.
fn integral(rule: &[(f64, f64)], domain: ParamTriangle, density: impl Fn(f64, f64) -> f64) -> f64 {
    let nodes = || {
        rule.iter()
            .flat_map(|&(at, weight)| [(-at, weight), (at, weight)])
    };
    let mut sum = 0.0;
    for (x, of_x) in nodes() {
        let x = 0.5 + 0.5 * x;
        for (y, of_y) in nodes() {
            let y = (0.5 + 0.5 * y) * (1.0 - x);
            let [u, v] = domain.at([x, y]);
            sum += of_x * of_y * (1.0 - x) * density(u, v);
        }
    }
    0.25 * sum * domain.size * domain.size
}
