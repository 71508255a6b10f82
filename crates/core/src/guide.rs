//! Ten things people do, each with an example that compiles.
//!
//! All examples start from a control [`Mesh`](crate::Mesh). [`Mesh::from_triangles`](crate::Mesh::from_triangles)
//! takes plain arrays; [`Mesh::from_soup`](crate::Mesh::from_soup) takes what a file holds, with its
//! defects, and reports what it repaired. All lengths are in the mesh's unit. Here models come from the crate `limitmesh-models`.
//!
//! # 1. Refine to a tolerance
//! ```
//! # let soup = limitmesh_models::find("torus").ok_or("no such model")?.soup();
//! # let mesh = limitmesh::Mesh::from_soup(&soup, &Default::default())?.0;
//! use limitmesh::refine::{ExactOptions, exact};
//! use limitmesh::scheme::Loop;
//!
//! // Every point of the mesh is within 0.01 of the limit surface, and the other way round.
//! let smooth = exact(&mesh, &Loop, &ExactOptions::default().tolerance(0.01))?;
//! assert!(smooth.error.certified && smooth.error.upper <= 0.01);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # 2. Refine to a number of triangles
//! ```
//! # let soup = limitmesh_models::find("torus").ok_or("no such model")?.soup();
//! # let mesh = limitmesh::Mesh::from_soup(&soup, &Default::default())?.0;
//! use limitmesh::refine::{ExactOptions, Finish, exact};
//! use limitmesh::scheme::Loop;
//!
//! // The error lies on both sides of the surface, so that fewer triangles do.
//! let options = ExactOptions::default().triangles(5_000).finish(Finish::Balanced);
//! let smooth = exact(&mesh, &Loop, &options)?;
//! assert!(smooth.mesh.face_count() <= 5_000);
//! println!("within {} to {}", smooth.error.lower, smooth.error.upper);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # 3. Keep sharp edges
//! ```
//! # let soup = limitmesh_models::find("cube").ok_or("no such model")?.soup();
//! # let mesh = limitmesh::Mesh::from_soup(&soup, &Default::default())?.0;
//! use limitmesh::refine::{ExactOptions, exact};
//! use limitmesh::scheme::Loop;
//!
//! // The edges of a cube turn by 90°.
//! let mesh = mesh.with_creases_above(40f64.to_radians())?;
//! assert_eq!(mesh.tags().creases.len(), 12);
//! let smooth = exact(&mesh, &Loop, &ExactOptions::default().tolerance(0.01))?;
//! // Each side of a sharp edge has normals of its own.
//! let surface = smooth.split_surface();
//! assert!(surface.positions.len() > smooth.mesh.vertex_count());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # 4. Pass through the vertices
//! ```
//! # let soup = limitmesh_models::find("icosphere").ok_or("no such model")?.soup();
//! # let mesh = limitmesh::Mesh::from_soup(&soup, &Default::default())?.0;
//! use limitmesh::interpolate::{InterpolateOptions, interpolate};
//! use limitmesh::limit::LimitTable;
//! use limitmesh::scheme::Loop;
//!
//! let control = interpolate(&mesh, &Loop, &InterpolateOptions::default())?.mesh;
//! let limits = LimitTable::new(&Loop).positions(&control)?;
//! for (limit, vertex) in limits.iter().zip(mesh.positions()) {
//!     assert!((0..3).all(|axis| (limit[axis] - vertex[axis]).abs() < 1e-9));
//! }
//! // Refine `control` as any other mesh.
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # 5. Carry a texture
//! ```
//! use limitmesh::carry::carried;
//! use limitmesh::mesh::{Channel, Domain, Semantic};
//! use limitmesh::refine::{ExactOptions, exact};
//! use limitmesh::{Mesh, scheme::Loop};
//!
//! let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
//! let mesh = Mesh::from_triangles(
//!     corners.map(|[x, y]| [x, y, x * y]).to_vec(),
//!     vec![[0, 1, 2], [0, 2, 3]],
//! )?;
//! let texture = Channel::new("uv", Semantic::TextureCoordinates, Domain::Corner, 2)
//!     .with(corners.concat(), vec![0, 1, 2, 0, 2, 3]);
//! // Each corner must have its place on its own control face.
//! let options = ExactOptions::default().tolerance(1e-3).flat_regions(false);
//! let smooth = exact(&mesh, &Loop, &options)?;
//! let textures = carried(&[texture], &mesh, &Loop, &smooth)?;
//! // One index into the values for each corner of each triangle.
//! assert_eq!(textures[0].indices.len(), 3 * smooth.mesh.face_count());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # 6. Evaluate the limit surface
//! ```
//! # let soup = limitmesh_models::find("torus").ok_or("no such model")?.soup();
//! # let mesh = limitmesh::Mesh::from_soup(&soup, &Default::default())?.0;
//! use limitmesh::{FaceId, LimitSurface, scheme::Loop};
//!
//! let surface = LimitSurface::new(&mesh, &Loop)?;
//! let point = surface.at(FaceId(0), [0.5, 0.25, 0.25]);
//! println!("{:?} with the normal {:?}", point.position, point.normal);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # 7. Measure how far two meshes are apart
//! ```
//! # let soup = limitmesh_models::find("torus").ok_or("no such model")?.soup();
//! # let mesh = limitmesh::Mesh::from_soup(&soup, &Default::default())?.0;
//! use limitmesh::measure::{CertifiedOptions, SamplingOptions, certified_hausdorff, hausdorff};
//! use limitmesh::refine::limit_reference;
//! use limitmesh::scheme::Loop;
//!
//! let fine = limit_reference(&mesh, &Loop, 3)?;
//! let (a, b) = (mesh.as_triangles(), fine.as_triangles());
//! let sampled = hausdorff(a, b, &SamplingOptions::default().samples(10_000))?;
//! let proven = certified_hausdorff(a, b, &CertifiedOptions::default())?;
//! assert!(sampled.symmetric() <= proven.upper());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # 8. Project points onto the limit surface
//! ```
//! # let soup = limitmesh_models::find("torus").ok_or("no such model")?.soup();
//! # let mesh = limitmesh::Mesh::from_soup(&soup, &Default::default())?.0;
//! use limitmesh::{LimitSurface, Proximity, scheme::Loop};
//!
//! let surface = LimitSurface::new(&mesh, &Loop)?;
//! let closest = Proximity::new(&surface)?.closest(mesh.positions(), 1e-9)?;
//! assert!(closest.iter().all(|c| c.distance < c.lower + 1e-9));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # 9. Simplify a fine mesh
//! ```
//! # let soup = limitmesh_models::find("torus").ok_or("no such model")?.soup();
//! # let mesh = limitmesh::Mesh::from_soup(&soup, &Default::default())?.0;
//! # let fine = limitmesh::refine::limit_reference(&mesh, &limitmesh::scheme::Loop, 3)?;
//! use limitmesh::simplify::{Features, SimplifyOptions, simplify};
//!
//! let options = SimplifyOptions::default().tolerance(Some(0.01));
//! let coarse = simplify(&fine, &Features::default(), &options)?;
//! assert!(coarse.mesh.face_count() < fine.face_count());
//! assert!(coarse.bound.is_some_and(|bound| bound <= 0.01));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # 10. Use a scheme of your own
//! A scheme is its masks. Limit positions and normals follow from them; distances are proven for
//! the Loop family and for Catmull–Clark, and estimated for others.
//! ```
//! # let soup = limitmesh_models::find("icosphere").ok_or("no such model")?.soup();
//! # let mesh = limitmesh::Mesh::from_soup(&soup, &Default::default())?.0;
//! use limitmesh::limit::LimitTable;
//! use limitmesh::ring::{EdgeShape, RingShape};
//! use limitmesh::scheme::{EdgeMask, Loop, Scheme, Support, VertexMask};
//!
//! /// Loop's scheme, with old vertices twice as heavy.
//! struct Heavy;
//!
//! impl Scheme for Heavy {
//!     fn name(&self) -> &str {
//!         "heavy"
//!     }
//!     fn support(&self) -> Support {
//!         Support::OneRing
//!     }
//!     fn vertex_mask(&self, shape: RingShape) -> VertexMask {
//!         let mut mask = Loop.vertex_mask(shape);
//!         mask.ring.iter_mut().for_each(|weight| *weight *= 0.5);
//!         mask.centre = 1.0 - mask.ring.iter().sum::<f64>();
//!         mask
//!     }
//!     fn edge_mask(&self, shape: EdgeShape) -> EdgeMask {
//!         Loop.edge_mask(shape)
//!     }
//! }
//!
//! let [heavy, usual] = [
//!     LimitTable::new(&Heavy).positions(&mesh)?,
//!     LimitTable::new(&Loop).positions(&mesh)?,
//! ];
//! let size = |p: [f64; 3]| p.iter().map(|x| x * x).sum::<f64>();
//! assert!(size(heavy[0]) > size(usual[0]));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
