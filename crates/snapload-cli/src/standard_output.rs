//! Standard output, and whether it was open when the program began.
//!
//! Before `main` Rust opens /dev/null in the place of a standard stream that is closed, so that no file
//! takes its number by chance. From then on nothing tells it from one that was sent to /dev/null on
//! purpose, and what is written to it is lost without a word. So it is looked at earlier.
#![cfg_attr(
    target_os = "linux",
    expect(unsafe_code, reason = "a function that runs before main; see below")
)]
use std::io::{self, ErrorKind, StdoutLock};
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether it was closed when the program began; known on Linux alone.
static CLOSED: AtomicBool = AtomicBool::new(false);

#[cfg(target_os = "linux")]
extern "C" fn look() {
    let flags = rustix::io::fcntl_getfd(rustix::stdio::stdout());
    CLOSED.store(flags.is_err(), Ordering::Relaxed);
}

// SAFETY: what stands in this section is called once, on one thread, before `main`, as a function
// of C without arguments that it needs or a result; `look` is one, and uses nothing that Rust only
// sets up later: one call of the system and one atomic.
#[cfg(target_os = "linux")]
#[used]
#[unsafe(link_section = ".init_array")]
static LOOK: extern "C" fn() = look;

/// Standard output, to write to.
///
/// # Errors
/// That it is closed.
pub(crate) fn standard_output() -> io::Result<StdoutLock<'static>> {
    if CLOSED.load(Ordering::Relaxed) {
        return Err(io::Error::new(ErrorKind::NotConnected, "it is closed"));
    }
    Ok(io::stdout().lock())
}
