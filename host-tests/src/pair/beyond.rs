//! What lies beyond a search, as far as matches that agree with each other tell.

use super::agreement::FEWEST;
use super::matches::{PairMatches, STILL};
use stereopsis::matching::Config;

/// The share of the matches that a search may miss before that is said.
const MISSED: f64 = 0.05;
/// How many these have to be at least.
const FEWEST_MISSED: usize = FEWEST / 4;
/// How many of them have to be before every search: five to seven wrong ones that agree were seen in pairs
/// with little texture or much noise.
const FEWEST_BEFORE: usize = FEWEST / 2;

/// What of a pair's matches a search holds.
pub(super) struct Beyond<'a> {
    config: &'a Config,
    /// The search that holds what the pair shows, where one is known.
    better: Option<[u16; 2]>,
    /// Disparities that agree with others, or that the better search holds, in ascending order, px.
    trusted: Vec<f64>,
    /// The largest of things that have several matches in one place.
    nearest: Option<f64>,
    /// All matches in rows.
    matches: usize,
}

impl<'a> Beyond<'a> {
    pub fn of(matches: &PairMatches, config: &'a Config, better: Option<[u16; 2]>) -> Self {
        let (surfaces, nearest) = (matches.surfaces_px(), matches.things_px().last().copied());
        let is_held = |d: f64| better.is_some_and(|better| holds(better, d));
        let is_near_others = |d: f64| surfaces.binary_search_by(|other| other.total_cmp(&d)).is_ok();
        let all = matches.disparities_px().into_iter();
        let trusted = all.filter(|&d| is_held(d) || is_near_others(d)).collect();
        Self { config, better, trusted, nearest, matches: matches.in_rows.len() }
    }

    /// The share of the matches that lie before or after the search.
    pub fn share(&self) -> f64 {
        self.before() + self.after()
    }

    fn before(&self) -> f64 {
        let first = f64::from(self.config.min_disparity) - STILL;
        self.share_of(self.trusted.partition_point(|&d| d < first))
    }

    fn after(&self) -> f64 {
        let last = f64::from(self.config.min_disparity + self.config.disparities - 1);
        self.share_of(self.trusted.len() - self.trusted.partition_point(|&d| d <= last))
    }

    fn share_of(&self, count: usize) -> f64 {
        count as f64 / self.matches.max(1) as f64
    }

    /// How many disparities that are trusted a search holds.
    fn held(&self, search: [u16; 2]) -> usize {
        self.trusted.iter().filter(|&&d| holds(search, d)).count()
    }

    /// Whether a share of the matches is over [`MISSED`], and that many.
    fn is_missed(&self, share: f64, fewest: usize) -> bool {
        share > MISSED && (share * self.matches as f64).round() >= fewest as f64
    }

    /// What is to be known about the search, where it misses what features show: what is before every search,
    /// and what another search would hold.
    pub fn warnings(&self) -> [Option<String>; 2] {
        let at = |share: f64| {
            let place = share * self.trusted.len().saturating_sub(1) as f64;
            self.trusted.get(place.round() as usize).copied()
        };
        let Some((first, last)) = at(0.02).zip(at(0.98)) else { return [None, None] };
        let (before, config) = (self.before(), self.config);
        let is_before_all = config.min_disparity == 0 && self.is_missed(before, FEWEST_BEFORE);
        let below = is_before_all.then(|| {
            format!(
                "{:.0} % of the features have disparities below 0, down to {first:.0} px, where nothing is \
                 searched; shift the right image to the left by as much, or rectify the pair anew",
                100.0 * before
            )
        });
        // No search holds what is below 0.
        let missed = self.after() + if config.min_disparity == 0 { 0.0 } else { before };
        let searched = [config.min_disparity, config.disparities];
        let end = f64::from(config.min_disparity + config.disparities - 1);
        let nearest = self.nearest.filter(|&thing| thing > end);
        if !self.is_missed(missed, FEWEST_MISSED) && nearest.is_none() {
            return [below, None];
        }
        let better = self.better.filter(|&better| self.held(better) > self.held(searched));
        let cure = if let Some([first, count]) = better {
            format!("give --min-disparity {first} --disparities {count}")
        } else if config.disparities >= Config::MOST_DISPARITIES {
            format!("at most {} can be searched: make the images smaller", config.disparities)
        } else {
            return [below, None];
        };
        let missed = format!(
            "{:.0} % of the features lie beyond disparities {} to {end}, where they are from {first:.0} to \
             {:.0} px; {cure}",
            100.0 * missed,
            searched[0],
            nearest.map_or(last, |nearest| nearest.max(last)),
        );
        [below, Some(missed)]
    }
}

/// Whether a search, from its first disparity on so many, holds a disparity.
fn holds([first, count]: [u16; 2], d: f64) -> bool {
    let (first, last) = (f64::from(first), f64::from(first) + f64::from(count) - 1.0);
    d >= first - STILL && d <= last
}
