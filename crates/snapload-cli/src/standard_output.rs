//! Standard output, and whether it was open when the program began.
//!
//! Before `main`, Rust opens /dev/null in place of a standard stream that is closed, so that no
//! other file gets its number. After that it can not be distinguished from one that was redirected
//! to /dev/null on purpose, and output to it is lost without an error. So it is checked earlier.
#![cfg_attr(
    target_os = "linux",
    expect(unsafe_code, reason = "a function that runs before main; see below")
)]
use std::io::{self, ErrorKind, StdoutLock};
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether it was closed when the program began; known on Linux alone.
static STDOUT_CLOSED: AtomicBool = AtomicBool::new(false);

#[cfg(target_os = "linux")]
extern "C" fn check_standard_output() {
    let flags = rustix::io::fcntl_getfd(rustix::stdio::stdout());
    STDOUT_CLOSED.store(flags.is_err(), Ordering::Relaxed);
}

// SAFETY: a function in this section is called once, on one thread, before `main`, as a C function
// without arguments that it needs or a result; `check_standard_output` is such a function, and uses
// nothing that Rust initialises later: one system call and one atomic.
#[cfg(target_os = "linux")]
#[used]
#[unsafe(link_section = ".init_array")]
static CHECK_STANDARD_OUTPUT: extern "C" fn() = check_standard_output;

/// Standard output, to write to.
///
/// # Errors
/// That it is closed.
pub(crate) fn standard_output() -> io::Result<StdoutLock<'static>> {
    if STDOUT_CLOSED.load(Ordering::Relaxed) {
        return Err(io::Error::new(ErrorKind::NotConnected, "it is closed"));
    }
    Ok(io::stdout().lock())
}
