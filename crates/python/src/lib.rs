//! The native half of the Python package `limitmesh`: NumPy arrays in, the library's functions without the interpreter's lock,
//! arrays out.
//!
//! Arguments are checked and completed by the package's Python half, which is what people call; here each function takes arrays
//! and a dictionary in which every option stands.

mod channels;
mod control;
mod errors;
mod files;
mod front;
mod levels;
mod limit;
mod measure;
mod options;
mod origins;
mod page;
mod picture;
mod pool;
mod program;
mod project;
mod rays;
mod refine;
mod replay;
mod run;
mod simplify;
mod soup;
mod surface;
mod tell;

use pyo3::prelude::*;

/// Functions over NumPy arrays; see the package's own functions.
#[pymodule]
mod _limitmesh {
    #[pymodule_export]
    use super::errors::{Error, MeshError, OptionError, ReadError};
    #[pymodule_export]
    use super::files::{load, models, save};
    #[pymodule_export]
    use super::front::Front;
    #[pymodule_export]
    use super::front::end_threads;
    #[pymodule_export]
    use super::levels::{levels_of_detail, switching_distance};
    #[pymodule_export]
    use super::limit::limit;
    #[pymodule_export]
    use super::measure::{examine, measure, measure_limit};
    #[pymodule_export]
    use super::origins::Origins;
    #[pymodule_export]
    use super::page::page;
    #[pymodule_export]
    use super::picture::picture;
    #[pymodule_export]
    use super::program::{batch, program, refine_file};
    #[pymodule_export]
    use super::project::project;
    #[pymodule_export]
    use super::rays::intersect;
    #[pymodule_export]
    use super::refine::{estimate, refine};
    #[pymodule_export]
    use super::replay::{Replay, refine_frames, replay};
    #[pymodule_export]
    use super::simplify::{repair, simplify};
    #[pymodule_export]
    use super::surface::{facing, limit_surface};

    use pyo3::prelude::*;
    use pyo3::types::PyTuple;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        let names = limitmesh::mesh::Diagnosis::default()
            .findings()
            .map(|(name, _)| name)
            .collect::<Vec<_>>();
        module.add("FINDINGS", PyTuple::new(module.py(), names)?)?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
