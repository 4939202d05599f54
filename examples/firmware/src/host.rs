//! Files and the console of the host, by semihosting, without a panic.
//!
//! The crate `semihosting` asserts in every call that a handle is not -1; looking first lets the compiler
//! drop that.

use core::ffi::CStr;
use semihosting::fd::{AsFd, BorrowedFd, OwnedFd};
use semihosting::io::ErrorKind;
use semihosting::sys::arm_compat::{OpenMode, sys_open, sys_read_orig, sys_write_orig};

/// A file on the host, relative to the emulator's working directory.
pub struct HostFile(OwnedFd);

/// The host did not do what it was asked for.
#[derive(Clone, Copy, PartialEq, Eq, Debug, defmt::Format)]
pub struct HostError;

impl HostFile {
    /// A file for reading; `None` when there is none of that name.
    ///
    /// # Errors
    /// When there is one and the host does not open it.
    pub fn open(name: &CStr) -> Result<Option<Self>, HostError> {
        match sys_open(name, OpenMode::RDONLY_BINARY) {
            Ok(handle) => Ok(Some(Self(handle))),
            Err(e) if e.kind() == ErrorKind::NotFound => Ok(None),
            Err(_) => Err(HostError),
        }
    }

    /// A new file in place of one of that name.
    ///
    /// # Errors
    /// When the host does not make it.
    pub fn create(name: &CStr) -> Result<Self, HostError> {
        sys_open(name, OpenMode::WRONLY_TRUNC_BINARY).map(Self).map_err(|_| HostError)
    }

    /// The host's console.
    ///
    /// # Errors
    /// When there is none.
    pub fn console() -> Result<Self, HostError> {
        sys_open(c":tt", OpenMode::WRONLY_TRUNC).map(Self).map_err(|_| HostError)
    }

    /// Reads as many bytes as there are, up to the buffer's length; how many.
    ///
    /// # Errors
    /// When the host cannot read.
    pub fn read(&self, bytes: &mut [u8]) -> Result<usize, HostError> {
        let length = bytes.len();
        let missing = sys_read_orig(self.handle()?, bytes).map_err(|_| HostError)?;
        length.checked_sub(missing).ok_or(HostError)
    }

    /// Writes all the bytes.
    ///
    /// # Errors
    /// When the host does not take all of them.
    pub fn write(&self, bytes: &[u8]) -> Result<(), HostError> {
        match sys_write_orig(self.handle()?, bytes) {
            Ok(0) => Ok(()),
            _ => Err(HostError),
        }
    }

    fn handle(&self) -> Result<BorrowedFd<'_>, HostError> {
        if self.0.as_raw_fd() == -1 { Err(HostError) } else { Ok(self.0.as_fd()) }
    }
}
