//! What a rectified rig tells with a search: `z = f b / (d + doffs)`, `sigma_z = z^2 / (f b) sigma_d`
//! (Siegwart, Nourbakhsh & Scaramuzza 2011, 4.2.5), as numbers and in words.

use std::fmt::Write;

/// A rig and its search.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Reach {
    /// Focal length x baseline, px m.
    pub fb_px_m: f64,
    /// What is added to a disparity before it divides, px.
    pub offset_px: f64,
    /// The smallest disparity searched, px.
    pub min_disparity: u16,
    /// How many whole disparities are searched.
    pub disparities: u16,
    /// Standard deviation of a disparity, px.
    pub sigma_px: f64,
}

impl Reach {
    /// The standard deviation of a disparity that depths are told with, px: that of the methods, away from
    /// depth edges.
    pub const SIGMA_PX: f64 = 0.15;

    /// The largest whole disparity, px.
    pub fn most_px(&self) -> f64 {
        f64::from(self.min_disparity) + f64::from(self.disparities) - 1.0
    }

    /// The depth at the largest whole disparity, m; `None` where that is at infinity or behind.
    pub fn nearest_m(&self) -> Option<f64> {
        let parallax = self.most_px() + self.offset_px;
        (parallax > 0.0).then(|| self.fb_px_m / parallax)
    }

    /// The depth at the smallest disparity searched, or at a parallax of 1 px where that is more, m.
    pub fn farthest_m(&self) -> f64 {
        self.fb_px_m / (f64::from(self.min_disparity) + self.offset_px).max(1.0)
    }

    /// The standard deviation of a depth, m.
    pub fn sigma_m(&self, depth_m: f64) -> f64 {
        depth_m * depth_m / self.fb_px_m * self.sigma_px
    }

    /// The depth whose standard deviation is that share of it, m.
    pub fn within_m(&self, share: f64) -> f64 {
        share * self.fb_px_m / self.sigma_px
    }

    /// The disparity of a depth, px.
    pub fn disparity_px(&self, depth_m: f64) -> f64 {
        self.fb_px_m / depth_m - self.offset_px
    }

    /// Whether a depth has a disparity of the search, and a parallax of 1 px at least.
    pub fn tells(&self, depth_m: f64) -> bool {
        let searched = f64::from(self.min_disparity)..=self.most_px();
        searched.contains(&self.disparity_px(depth_m)) && self.fb_px_m / depth_m >= 1.0
    }

    /// Lines of text: from where to where depths are told, then how well at those of the distances that are.
    pub fn describe(&self, distances_m: &[f64], text: &mut String) {
        let (most, sigma_px) = (self.most_px(), self.sigma_px);
        let Some(nearest_m) = self.nearest_m() else {
            let _ = writeln!(
                text,
                "depths       none: {most} px is at infinity or behind; search more disparities"
            );
            return;
        };
        let (searched, least) = (self.disparities, self.min_disparity);
        let (tenth_m, farthest_m) = (self.within_m(0.1), self.farthest_m());
        let to = if farthest_m < tenth_m {
            format!("{farthest_m:.3} m ({least} px)")
        } else {
            format!("about {tenth_m:.1} m, where an error of {sigma_px} px is a tenth")
        };
        let _ = writeln!(
            text,
            "depths       from {nearest_m:.3} m ({most} px, of a search of {searched}) to {to}"
        );
        for &z in distances_m.iter().filter(|z| self.tells(**z)) {
            let (disparity, sigma_mm) = (self.disparity_px(z), 1000.0 * self.sigma_m(z));
            let _ =
                writeln!(text, "  at {z:5.2} m  {disparity:6.1} px, +- {sigma_mm:.1} mm for {sigma_px} px");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::MethodName;

    #[test]
    fn the_deviation_is_that_of_all_methods() {
        assert!(MethodName::ALL.iter().all(|method| method.sigma_px() == Reach::SIGMA_PX as f32));
    }

    #[test]
    fn worked_by_hand() {
        // 500 px x 0.1 m: 50 px at 1 m, 10 px at 5 m.
        let reach = Reach { fb_px_m: 50.0, offset_px: 0.0, min_disparity: 8, disparities: 48, sigma_px: 0.1 };
        assert_eq!((reach.most_px(), reach.disparity_px(5.0)), (55.0, 10.0));
        assert!(reach.tells(5.0) && !reach.tells(10.0) && !reach.tells(0.9));
        assert_eq!((reach.farthest_m(), Reach { min_disparity: 0, ..reach }.farthest_m()), (6.25, 50.0));
        assert_eq!(Reach { offset_px: 12.0, ..reach }.farthest_m(), 2.5);
        assert!((reach.sigma_m(5.0) - 0.05).abs() < 1e-12 && (reach.within_m(0.01) - 5.0).abs() < 1e-12);
    }
}
