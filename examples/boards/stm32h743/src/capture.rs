//! Lines by DCMI: a circular DMA over two lines, each copied into a slot of the queue while the other fills.

use crate::Irqs;
use board_matchers::one_core::Destination;
use board_matchers::{HEIGHT, LINE};
use core::cell::UnsafeCell;
use embassy_stm32::Peri;
use embassy_stm32::dcmi::{
    D0Pin, D1Pin, D2Pin, D3Pin, D4Pin, D5Pin, D6Pin, D7Pin, FrameDma, HSyncPin, PixClkPin, VSyncPin,
};
use embassy_stm32::dma::{Channel, ReadableRingBuffer, Request, TransferOptions};
use embassy_stm32::gpio::{AfType, Flex, Pull};
use embassy_stm32::pac;
use embassy_stm32::peripherals::{DCMI, DMA1_CH0, PA4, PA6, PB7, PB8, PB9, PC6, PC7, PC8, PC9, PC11, PD3};
use embassy_time::{Duration, Instant, with_timeout};
use stereopsis::camera::{FrameStart, LineStart};

/// Words of a line, four pixels each.
const WORDS: usize = LINE / 4;
/// From line to line, blanking between two frames included.
const NO_LINE: Duration = Duration::from_millis(200);

/// Two lines, written by the DMA.
struct TwoLines(UnsafeCell<[u32; 2 * WORDS]>);

#[allow(unsafe_code)]
// SAFETY: `run` alone takes a reference to the lines, once.
unsafe impl Sync for TwoLines {}

#[allow(unsafe_code)]
// SAFETY: the section has room for them, and the linker puts nothing else over them. It is not written at the
// start, which words allow: `run` writes them before they are read.
#[unsafe(link_section = ".axiram")]
static TWO_LINES: TwoLines = TwoLines(UnsafeCell::new([0; 2 * WORDS]));

/// A pin of the chip that nobody else has.
type Held<P> = Peri<'static, P>;

/// The camera's pins, of which each has the port's function that its name says.
pub struct Pins {
    /// D0 to D3.
    pub low: (Held<PC6>, Held<PC7>, Held<PC8>, Held<PC9>),
    /// D4 to D7.
    pub high: (Held<PC11>, Held<PD3>, Held<PB8>, Held<PB9>),
    /// VSYNC: high between two frames.
    pub vsync: Held<PB7>,
    /// HSYNC: low between two lines.
    pub hsync: Held<PA4>,
    /// PIXCLK: data are valid while it rises.
    pub clock: Held<PA6>,
}

impl Pins {
    /// Gives the pins to the port, for good.
    fn connect(self) {
        let Self { low: (d0, d1, d2, d3), high: (d4, d5, d6, d7), vsync, hsync, clock } = self;
        let functions = [
            D0Pin::<DCMI>::af_num(&*d0),
            D1Pin::<DCMI>::af_num(&*d1),
            D2Pin::<DCMI>::af_num(&*d2),
            D3Pin::<DCMI>::af_num(&*d3),
            D4Pin::<DCMI>::af_num(&*d4),
            D5Pin::<DCMI>::af_num(&*d5),
            D6Pin::<DCMI>::af_num(&*d6),
            D7Pin::<DCMI>::af_num(&*d7),
            VSyncPin::<DCMI>::af_num(&*vsync),
            HSyncPin::<DCMI>::af_num(&*hsync),
            PixClkPin::<DCMI>::af_num(&*clock),
        ];
        let pins = [
            Flex::new(d0),
            Flex::new(d1),
            Flex::new(d2),
            Flex::new(d3),
            Flex::new(d4),
            Flex::new(d5),
            Flex::new(d6),
            Flex::new(d7),
            Flex::new(vsync),
            Flex::new(hsync),
            Flex::new(clock),
        ];
        for (mut pin, function) in pins.into_iter().zip(functions) {
            pin.set_as_af_unchecked(function, AfType::input(Pull::None));
            // A pin that is dropped is disconnected.
            core::mem::forget(pin);
        }
    }
}

/// The port, and where its lines go.
pub struct Port {
    channel: Channel<'static>,
    request: Request,
    to: Destination,
}

impl Port {
    /// Sets the port up. Nothing is captured yet.
    pub fn new(
        _port: Peri<'static, DCMI>,
        dma: Peri<'static, DMA1_CH0>,
        interrupts: Irqs,
        pins: Pins,
        to: Destination,
    ) -> Self {
        pins.connect();
        let request = FrameDma::<DCMI>::request(&*dma);
        Self { channel: Channel::new(dma, interrupts), request, to }
    }
}

/// Takes frames for ever. After a fault the port begins again with the next whole frame.
#[embassy_executor::task]
#[allow(unsafe_code)]
pub async fn run(port: Port) -> ! {
    let Port { mut channel, request, mut to } = port;
    let two_lines = TWO_LINES.0.get();
    // SAFETY: the task runs once, and nobody else takes this reference. The words are written before they are
    // read.
    let two_lines = unsafe {
        two_lines.write([0; 2 * WORDS]);
        &mut *two_lines
    };
    let data = pac::DCMI.dr().as_ptr().cast::<u32>();
    let mut sequence = 0u32;
    loop {
        // The ring begins with the first word of a frame, for which the port waits.
        set_up();
        let options = TransferOptions::default();
        // SAFETY: the port's data register is read by this channel alone, and the lines are in memory that
        // the DMA reaches; they live as long as the program.
        let mut ring =
            unsafe { ReadableRingBuffer::new(channel.reborrow(), request, data, &mut *two_lines, options) };
        ring.start();
        begin();
        let mut is_first = true;
        while frame(&mut ring, sequence, is_first, &mut to).await {
            (sequence, is_first) = (sequence.wrapping_add(1), false);
        }
        sequence = sequence.wrapping_add(1);
    }
}

/// Sets the port up. A reset stops it within a frame too, and leaves neither flags nor words of a broken
/// line.
fn set_up() {
    embassy_stm32::rcc::enable_and_reset::<DCMI>();
    pac::DCMI.cr().write(|cr| {
        cr.set_cm(false); // One frame after the other,
        cr.set_fcrc(0); // every one of them,
        cr.set_edm(0); // 8 bits of a pixel,
        cr.set_ess(false); // with pins for the synchronisation:
        cr.set_pckpol(true); // taken at rising edges,
        cr.set_vspol(true); // not while VSYNC is high,
        cr.set_hspol(false); // nor while HSYNC is low.
    });
}

/// Has the port wait for a frame.
fn begin() {
    pac::DCMI.cr().modify(|cr| {
        cr.set_enable(true);
        cr.set_capture(true);
    });
}

/// Hands a frame on, line by line; false when the port and the ring are no longer in step.
async fn frame(
    ring: &mut ReadableRingBuffer<'_, u32>,
    sequence: u32,
    is_first: bool,
    to: &mut Destination,
) -> bool {
    let mut start = FrameStart { sequence, timestamp_us: 0, exposure_us: 0 };
    for row in 0..HEIGHT {
        let mut words = [0; WORDS];
        // The ring says so when the DMA was in the line again before it was copied.
        let Ok(Ok(_)) = with_timeout(NO_LINE, ring.read_exact(&mut words)).await else { return false };
        let timestamp_us = Instant::now().as_micros();
        let flags = pac::DCMI.ris().read();
        if flags.ovr_ris() || flags.err_ris() {
            return false;
        }
        if row == 0 {
            // The frame before has ended, and it alone. The flag of the last line comes with the blanking.
            if flags.frame_ris() == is_first {
                return false;
            }
            pac::DCMI.icr().write(|flags| flags.set_frame_isc(true));
            start.timestamp_us = timestamp_us;
        } else if flags.frame_ris() && row + 2 < HEIGHT {
            return false;
        }
        let Some(mut line) = to.producer.begin() else { continue };
        for (bytes, word) in line.bytes().chunks_exact_mut(4).zip(words) {
            bytes.copy_from_slice(&word.to_le_bytes());
        }
        to.producer.finish(line, start, LineStart { row, timestamp_us });
        to.notifier.notify();
    }
    true
}
