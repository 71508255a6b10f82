//! The settings of an emission.

use super::super::chains::Chains;
use super::super::control::Control;
use super::super::cover::Cover;
use super::super::quadtree::Trees;

/// The settings of an emission.
#[derive(Clone, Copy)]
pub(in super::super) struct Emitter<'a> {
    pub(in super::super) control: &'a Control<'a>,
    pub(in super::super) trees: &'a Trees,
    pub(in super::super) chains: &'a Chains,
    /// By control face.
    pub(in super::super) covers: &'a [Cover],
    /// By control face, whether it may be another than when it was emitted before.
    pub(in super::super) is_changed: &'a [bool],
    pub(in super::super) has_origins: bool,
    /// Whether vertices will be moved.
    pub(in super::super) is_balanced: bool,
}
