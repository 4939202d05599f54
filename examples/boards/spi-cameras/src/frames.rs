//! A frame of both cameras through the pipeline: while a pair of lines is matched, the next one is on its
//! way.

use crate::mega::{Mega, MegaError, PICTURE_MS, SETTING_MS, SIZE};
use embassy_futures::join::{join, join3};
use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::spi::SpiDevice;
use stereopsis::matching::{Block, Config, MatchError, Row};
use stereopsis::pipeline::{Pipeline, PushError};

/// Disparities that are searched.
pub const DISPARITIES: usize = 32;

/// The pipeline that has room for a frame.
pub type Rows = Pipeline<Block, SIZE, DISPARITIES>;

/// The configuration of a frame.
pub fn config() -> Config {
    Config::for_method::<Block>(SIZE as u16, SIZE as u16, DISPARITIES as u16)
}

/// Why a frame broke off.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum FrameError<L, R> {
    /// The left camera has no picture.
    Left(MegaError<L>),
    /// The right camera has no picture.
    Right(MegaError<R>),
    /// The pipeline was not started.
    Begin(MatchError),
    /// The pipeline was not started with [`config`].
    Match(PushError),
}

impl<L, R> FrameError<L, R> {
    /// What to show: where it was, what it was, and a number that says more: `left unknown 66`.
    pub fn words(&self) -> (&'static str, &'static str, u32) {
        fn of<E>(error: &MegaError<E>) -> (&'static str, u32) {
            match error {
                MegaError::Bus(_) => ("bus", 0),
                MegaError::Unknown(camera) => ("unknown", u32::from(*camera)),
                MegaError::Settings => ("settings", SETTING_MS),
                MegaError::Picture => ("picture", PICTURE_MS),
                MegaError::Short(length) => ("short", *length),
            }
        }
        let (at, (what, number)) = match self {
            Self::Left(error) => ("left", of(error)),
            Self::Right(error) => ("right", of(error)),
            Self::Begin(_) | Self::Match(_) => ("pipeline", ("start", 0)),
        };
        (at, what, number)
    }
}

/// Both cameras, and what makes them wait.
#[derive(Debug)]
pub struct Cameras<L, R, D> {
    /// The left camera.
    pub left: Mega<L>,
    /// The right camera.
    pub right: Mega<R>,
    /// A timer for each.
    pub delays: [D; 2],
}

impl<L: SpiDevice, R: SpiDevice, D: DelayNs> Cameras<L, R, D> {
    /// Sets both cameras up.
    ///
    /// # Errors
    /// When one of them cannot be.
    pub async fn set_up(&mut self) -> Result<(), FrameError<L::Error, R::Error>> {
        let [first, second] = &mut self.delays;
        both(join(self.left.set_up(first), self.right.set_up(second)).await)
    }

    /// Waits for a second, after a fault that stays.
    pub async fn rest(&mut self) {
        let [delay, _] = &mut self.delays;
        delay.delay_ms(1000).await;
    }

    /// Takes a frame and gives its rows to `show` as they come out.
    ///
    /// # Errors
    /// When a camera fails: set both up again, and take the next one.
    pub async fn frame(
        &mut self,
        rows: &mut Rows,
        mut show: impl FnMut(&Row<'_>),
    ) -> Result<(), FrameError<L::Error, R::Error>> {
        let Self { left, right, delays: [first, second] } = self;
        both(join(left.take(), right.take()).await)?;
        both(join(left.taken(first), right.taken(second)).await)?;
        rows.begin().map_err(FrameError::Begin)?;
        // A pair of lines is on its way while the other one is matched: the transfers are polled first, and
        // so begin before the matcher does.
        let mut lines = [[[0; SIZE]; 2]; 2];
        let [coming, there] = &mut lines;
        let (mut coming, mut there) = (coming, there);
        for row in 0..=SIZE {
            // The first time there is nothing to match yet, the last time nothing comes any more.
            let matched = async {
                if row > 0
                    && let Some(row) = rows.push(&there[0], &there[1])?
                {
                    show(&row);
                }
                Ok(())
            };
            let matched = if row < SIZE {
                let [to_left, to_right] = &mut *coming;
                let (l, r, matched) = join3(left.line(to_left), right.line(to_right), matched).await;
                both((l, r))?;
                matched
            } else {
                matched.await
            };
            matched.map_err(FrameError::Match)?;
            (coming, there) = (there, coming);
        }
        while let Some(row) = rows.flush().map_err(FrameError::Match)? {
            show(&row);
        }
        Ok(())
    }
}

/// What went wrong with one of the two.
fn both<L, R>(results: (Result<(), MegaError<L>>, Result<(), MegaError<R>>)) -> Result<(), FrameError<L, R>> {
    results.0.map_err(FrameError::Left)?;
    results.1.map_err(FrameError::Right)
}
