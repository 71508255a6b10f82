//! The document as it was read: its text, its JSON, and the bytes that its buffers and views name.

mod accessor;
pub(crate) mod codecs;
pub(crate) mod container;
pub(crate) mod extensions;
pub(crate) mod json;
pub(crate) mod numbers;
pub(crate) mod source;
pub(crate) mod text;
pub(crate) mod uri;
mod zeros;
