//! A page that shows refined meshes in a browser.
//!
//! Takes meshes as GLB files, with what is known of them; gives one HTML file that needs nothing else ([`Page::html`]), or the answers of a
//! server to the same page ([`Stop::answer`]). The page itself is built from `npm/page`, and knows how to draw. This crate puts data into it.

mod page;
mod report;
mod stop;

pub use page::{Left, Live, Page};
pub use report::{Report, UniformReport};
pub use stop::Stop;
