//! defmt through semihosting: the encoded log goes to a file on the host, where the ELF file says what it
//! means.

use crate::host::HostFile;
use core::cell::RefCell;
use core::ffi::CStr;
use critical_section::{Mutex, RestoreState};
use defmt::{Encoder, Logger};

/// The file, in the emulator's working directory; `defmt-print -e ELF < log.defmt` shows it.
pub const NAME: &CStr = c"log.defmt";

static LINK: Mutex<RefCell<Link>> = Mutex::new(RefCell::new(Link::CLOSED));

/// Where the log goes.
struct Link {
    file: Option<HostFile>,
    encoder: Encoder,
    restore: RestoreState,
}

impl Link {
    const CLOSED: Self = Self { file: None, encoder: Encoder::new(), restore: RestoreState::invalid() };

    fn send(&mut self, encode: impl FnOnce(&mut Encoder, &mut dyn FnMut(&[u8]))) {
        let Self { file, encoder, .. } = self;
        encode(encoder, &mut |bytes| {
            if let Some(file) = file {
                // Nobody is there to be told when the log fails.
                let _ = file.write(bytes);
            }
        });
    }
}

/// Opens the log; without it nothing is logged.
pub fn start() {
    with_link(|link| link.file = HostFile::create(NAME).ok());
}

/// The link, which nobody else can hold: interrupts are off, and `f` logs nothing.
fn with_link(f: impl FnOnce(&mut Link)) {
    critical_section::with(|cs| {
        if let Ok(mut link) = LINK.borrow(cs).try_borrow_mut() {
            f(&mut link);
        }
    });
}

/// What the macros of defmt write to.
#[defmt::global_logger]
struct FileLogger;

#[allow(unsafe_code)]
// SAFETY: between `acquire` and `release` interrupts are off on the only core, so that messages do not mix.
unsafe impl Logger for FileLogger {
    fn acquire() {
        // SAFETY: `release`, which defmt calls after every `acquire`, gives it back.
        let restore = unsafe { critical_section::acquire() };
        with_link(|link| {
            link.restore = restore;
            link.send(|encoder, out| encoder.start_frame(out));
        });
    }

    // SAFETY: the host has every byte as soon as it is written.
    unsafe fn flush() {}

    // SAFETY: defmt calls it once after `acquire`.
    unsafe fn release() {
        let mut restore = RestoreState::invalid();
        with_link(|link| {
            link.send(|encoder, out| encoder.end_frame(out));
            restore = link.restore;
        });
        // SAFETY: this is what `acquire` got.
        unsafe { critical_section::release(restore) }
    }

    // SAFETY: defmt calls it between `acquire` and `release`.
    unsafe fn write(bytes: &[u8]) {
        with_link(|link| link.send(|encoder, out| encoder.write(bytes, out)));
    }
}
