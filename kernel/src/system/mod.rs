//! Access to threads, clocks and files of the machine; no other folder uses those of the standard library.
//!
//! [`threads::Pool`] distributes work so that the answer has the same bits for any number of threads;
//! [`clock`] has wall and CPU time in s; [`checksum`](mod@checksum) has the SHA-256 of files; [`Sink`] and
//! [`write_file`] write a file as a whole or not at all. In a web page the calling thread does all work,
//! files are those that the user has opened there, and a file that is written is a download.
//!
//! # Errors
//!
//! [`OpenError`] for an output that cannot be opened, [`threads::NoThreads`] where the system grants no
//! thread; `std::io::Error`, or a sentence, for the rest.
//!
//! # Example
//!
//! ```
//! # use interwell_kernel as interwell;
//! use interwell::system::checksum::checksum;
//!
//! assert!(checksum(b"").starts_with("e3b0c44298fc1c14"));
//! ```

pub mod checksum;
pub mod clock;
#[doc(hidden)]
pub mod files;
mod journal;
#[doc(hidden)]
pub mod lines;
mod lock;
#[cfg(target_arch = "wasm32")]
pub mod page;
mod part;
mod sink;
pub mod threads;

pub use journal::Block;
pub use part::{Opened, Part, PartError};
pub use sink::{OpenError, Sink, is_regular, write_file};

/// The address that stands before a link: in a web page that of the page, elsewhere what the environment
/// variable `INTERWELL_PAGE` has, up to a `?` or `#`. The error is a sentence.
#[doc(hidden)]
pub fn page_address() -> Result<String, String> {
    #[cfg(target_arch = "wasm32")]
    return Ok(page::address().to_owned());
    #[cfg(not(target_arch = "wasm32"))]
    {
        let set = std::env::var_os("INTERWELL_PAGE").unwrap_or_default();
        let set = set.to_string_lossy();
        let address = set.split(['?', '#']).next().unwrap_or_default();
        let starts = ["https://", "http://", "file:///"].iter().any(|start| address.starts_with(start));
        if !set.is_empty() && (!starts || address.contains(|c: char| c.is_whitespace() || c.is_control())) {
            return Err(format!(
                "INTERWELL_PAGE = {set:?} is not the address of a page: give one such as \
                 https://example.org/class/"
            ));
        }
        Ok(address.to_owned())
    }
}
