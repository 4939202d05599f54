//! Lines of both cameras by PIO and DMA, to the cores whose bands take them.

use board_matchers::two_cores::Destination;
use board_matchers::{HEIGHT, WIDTH};
use embassy_futures::join::join;
use embassy_rp::dma::Channel;
use embassy_rp::gpio::Output;
use embassy_rp::peripherals::PIO0;
use embassy_rp::pio::program::pio_file;
use embassy_rp::pio::{Common, Config, LoadedProgram, Pin, ShiftConfig, ShiftDirection, StateMachine};
use embassy_rp::pwm::Pwm;
use embassy_time::{Duration, Instant, Ticker, with_timeout};
use stereopsis::camera::{FrameStart, LineStart};

/// From frame to frame: the 82 lines of a band have to be done in this time.
const FRAME: Duration = Duration::from_millis(50);
/// From the trigger to the first line: the exposure and a few lines. From line to line it is 241 us.
const NO_LINE: Duration = Duration::from_millis(20);
/// Four pixels a word.
const WORDS: usize = WIDTH as usize / 4;

/// A line of a camera, as the DMA writes it.
type Words = [u32; WORDS];

/// Loads the program that both state machines run.
pub fn load(common: &mut Common<'static, PIO0>) -> LoadedProgram<'static, PIO0> {
    common.load_program(&pio_file!("src/camera.pio").program)
}

/// A camera: its state machine, and the DMA channel that empties it.
pub struct Camera<const SM: usize> {
    machine: StateMachine<'static, PIO0, SM>,
    config: Config<'static, PIO0>,
    dma: Channel<'static>,
    line: Words,
}

impl<const SM: usize> Camera<SM> {
    /// A camera on these pins, in the order of the program's.
    pub fn new(
        machine: StateMachine<'static, PIO0, SM>,
        program: &LoadedProgram<'static, PIO0>,
        pins: &[Pin<'static, PIO0>; 7],
        dma: Channel<'static>,
    ) -> Self {
        let mut config = Config::default();
        config.use_program(program, &[]);
        config.set_in_pins(&pins.each_ref());
        // The first half of a pixel comes to lie lowest, and so does the first pixel.
        config.shift_in = ShiftConfig { threshold: 32, direction: ShiftDirection::Right, auto_fill: true };
        Self { machine, config, dma, line: [0; WORDS] }
    }

    /// Has the state machine wait for a frame, whatever it did before.
    fn arm(&mut self) {
        self.machine.set_enable(false);
        self.machine.restart();
        self.machine.clear_fifos();
        // Its first instruction comes next.
        self.machine.set_config(&self.config);
        self.machine.tx().push(u32::from(HEIGHT) - 1);
        self.machine.tx().push(2 * u32::from(WIDTH) - 1);
        self.machine.set_enable(true);
    }

    /// Reads the next line. Between two lines the FIFO holds 16 pixels, and the sensor is silent for longer
    /// than an interrupt takes.
    async fn read(&mut self) {
        self.machine.rx().dma_pull(&mut self.dma, &mut self.line, false).await;
    }
}

/// Both cameras, their trigger, and where their lines go.
pub struct Capture {
    /// The left camera.
    pub left: Camera<0>,
    /// The right camera.
    pub right: Camera<1>,
    /// The pin TRIG of both sensors.
    pub trigger: Output<'static>,
    /// The cores' ends.
    pub to: [Destination; 2],
    /// The master clock, which stops when it is dropped.
    pub clock: Pwm<'static>,
}

/// Takes frames for ever. A line that does not come ends its frame: the cores see that it was short.
#[embassy_executor::task]
pub async fn run(capture: Capture) -> ! {
    let Capture { mut left, mut right, mut trigger, mut to, clock: _clock } = capture;
    let mut frames = Ticker::every(FRAME);
    let mut sequence = 0u32;
    loop {
        frames.next().await;
        left.arm();
        right.arm();
        sequence = sequence.wrapping_add(1);
        let timestamp_us = Instant::now().as_micros();
        let frame = FrameStart { sequence, timestamp_us, exposure_us: crate::sensors::EXPOSURE_US };
        // The sensors send frames while it is high: this one, until its last line is in.
        trigger.set_high();
        for row in 0..HEIGHT {
            // What has begun is taken back when the time is over: both channels are stopped.
            if with_timeout(NO_LINE, join(left.read(), right.read())).await.is_err() {
                break;
            }
            let start = LineStart { row, timestamp_us: Instant::now().as_micros() };
            for core in &mut to {
                core.hand_on(frame, start, |bytes| {
                    let words = left.line.iter().chain(&right.line);
                    for (to, word) in bytes.chunks_exact_mut(4).zip(words) {
                        to.copy_from_slice(&word.to_le_bytes());
                    }
                });
            }
        }
        trigger.set_low();
    }
}
