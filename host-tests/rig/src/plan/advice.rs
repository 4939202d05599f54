//! What limits a plan, and what would help: whole sentences, each with its figures.

use super::{Plan, Rig, STEP, Search, Tables};
use crate::method::MethodName;
use stereopsis::geometry::camera::ImageSize;

/// A clock that microcontrollers have, at most, MHz.
const FASTEST_MHZ: f64 = 1000.0;

/// What is wanted and not had, and what would help.
pub fn of(plan: &Plan, tables: &Tables) -> (Vec<String>, Vec<String>) {
    let (mut limits, mut changes) = (Vec::new(), Vec::new());
    for (limit, help) in
        [nearest(plan), farthest(plan), accuracy(plan), memory(plan, tables), speed(plan, tables)]
            .into_iter()
            .flatten()
    {
        limits.push(limit);
        changes.extend(help);
    }
    (limits, changes)
}

/// A limit, and what would help.
type Found = Option<(String, Vec<String>)>;

/// Whether the search reaches what is near.
fn nearest(plan: &Plan) -> Found {
    let (rig, wanted, search) = (&plan.rig, &plan.wanted, &plan.search);
    if search.needed <= u32::from(search.disparities) {
        return None;
    }
    let near = wanted.nearest_m;
    let limit = format!(
        "the search: depths from {near} m take {} disparities, and images {} px wide have {} at most: they \
         are told from {:.3} m on",
        search.needed, rig.width, search.disparities, plan.nearest_m
    );
    let mut changes = Vec::new();
    // The longest baseline whose search is to be had, in whole millimetres.
    let fits = |rig: &Rig| {
        let search = Search::of(rig, near, wanted.farthest_m);
        search.needed <= u32::from(search.disparities)
    };
    let with = |mm: u32| Rig { baseline_m: f64::from(mm) / 1000.0, ..*rig };
    let most = (1000.0 * rig.baseline_m).ceil() as u32;
    if let Some(mm) = (1..most).rev().find(|&mm| fits(&with(mm))) {
        let rig = with(mm);
        let end_m = Search::of(&rig, near, wanted.farthest_m).end_m(&rig).unwrap_or(f64::INFINITY);
        let reach = (rig.fb_px_m() * wanted.accuracy / plan.sigma_px).min(end_m);
        changes.push(format!(
            "a baseline of {mm} mm would begin at {near} m, and reach {reach:.1} m within {} %",
            percent(wanted.accuracy)
        ));
    }
    let half = Rig {
        baseline_m: rig.baseline_m,
        focal_px: rig.focal_px / 2.0,
        offset_px: rig.offset_px / 2.0,
        width: rig.width / 2,
        height: rig.height / 2,
    };
    if half.width >= STEP && fits(&half) {
        changes.push(format!(
            "images of {} x {} px, half the size, would begin at {near} m with {} disparities",
            half.width,
            half.height,
            Search::of(&half, near, wanted.farthest_m).disparities
        ));
    }
    Some((limit, changes))
}

/// Whether the search reaches what is far: where images are cropped alike it does down to infinity.
fn farthest(plan: &Plan) -> Found {
    let far = plan.wanted.farthest_m;
    let end_m = plan.end_m.filter(|&end_m| end_m < far)?;
    let disparity = plan.rig.disparity_px(far);
    let limit = format!(
        "the search: {far} m is at a disparity of {disparity:.1} px, below 0; nothing is told beyond \
         {end_m:.2} m"
    );
    Some((limit, vec!["images with the same principal point would reach infinity".to_owned()]))
}

/// Whether what is far is told well enough.
fn accuracy(plan: &Plan) -> Found {
    let (rig, wanted) = (&plan.rig, &plan.wanted);
    let far = wanted.farthest_m;
    if plan.reach_m >= far {
        return None;
    }
    let (share, aim) = (far * plan.sigma_px / rig.fb_px_m(), percent(wanted.accuracy));
    let limit = format!(
        "the accuracy: at {far} m the deviation is {} %, within {aim} % it is up to {:.2} m",
        percent(share),
        plan.reach_m
    );
    let times = share / wanted.accuracy;
    let longer = Rig { baseline_m: (1000.0 * rig.baseline_m * times).ceil() / 1000.0, ..*rig };
    let mut changes =
        vec![helped(plan, &longer, format!("a baseline of {:.0} mm", 1000.0 * longer.baseline_m))];
    let narrower = Rig { focal_px: (rig.focal_px * times).ceil(), ..*rig };
    let angle = narrower.angle_deg(rig.width);
    changes.push(helped(
        plan,
        &narrower,
        format!("a lens of {:.0} px, which sees {angle:.1} degrees,", narrower.focal_px),
    ));
    Some((limit, changes))
}

/// What another rig would reach, and what it would take.
fn helped(plan: &Plan, rig: &Rig, what: String) -> String {
    let (far, aim) = (plan.wanted.farthest_m, percent(plan.wanted.accuracy));
    let search = Search::of(rig, plan.wanted.nearest_m, far);
    let takes = if search.needed <= u32::from(search.disparities) {
        format!("with a search of {}", search.disparities)
    } else {
        let nearest_m = search.reach(rig).nearest_m().unwrap_or(f64::INFINITY);
        format!("but begin at {nearest_m:.3} m")
    };
    format!("{what} would reach {far} m within {aim} %, {takes}")
}

/// Whether a method's memory is there.
fn memory(plan: &Plan, tables: &Tables) -> Found {
    let most = plan.wanted.ram_bytes?;
    let takes = |work: &super::Work| work.ram_bytes + work.stack_bytes as usize;
    let least = plan.work.iter().min_by_key(|work| takes(work))?;
    if takes(least) <= most {
        return None;
    }
    let limit = format!(
        "the memory: {} takes {}{} bytes of RAM with its stack, where {most} are there",
        least.method,
        if least.ram_is_measured { "" } else { "up to " },
        takes(least)
    );
    let method: MethodName = least.method.parse().ok()?;
    let fits = |width: u16, disparities: u16| {
        let size = ImageSize { width, height: plan.rig.height };
        let work = tables.work(least.core, least.clock_mhz, method, size, disparities);
        work.is_some_and(|work| takes(&work) <= most)
    };
    let Search { disparities, .. } = plan.search;
    let narrower = (disparities..plan.rig.width).rev().find(|&width| fits(width, disparities));
    let change = match narrower {
        Some(width) => Some(format!("images {width} px wide would fit with {disparities} disparities")),
        None => smaller(plan).find(|(rig, search)| fits(rig.width, search.disparities)).map(
            |(Rig { width, height, .. }, Search { disparities, .. })| {
                format!("images of {width} x {height} px would fit with {disparities} disparities")
            },
        ),
    };
    Some((limit, change.into_iter().collect()))
}

/// The rig with images of a half of the size, a third, and so on, and its searches: an image of so many times
/// fewer columns has so many times fewer disparities.
fn smaller(plan: &Plan) -> impl Iterator<Item = (Rig, Search)> {
    let (rig, wanted) = (plan.rig, &plan.wanted);
    (2..=16u16)
        .map(move |times| Rig {
            focal_px: rig.focal_px / f64::from(times),
            width: rig.width / times,
            height: rig.height / times,
            ..rig
        })
        .take_while(|rig| rig.width >= STEP && rig.height > 0)
        .map(|rig| (rig, Search::of(&rig, wanted.nearest_m, wanted.farthest_m)))
}

/// Whether any core is fast enough.
fn speed(plan: &Plan, tables: &Tables) -> Found {
    let wanted = plan.wanted.frames_per_s?;
    let best = plan.work.iter().max_by(|a, b| a.frames_per_s.total_cmp(&b.frames_per_s))?;
    if best.frames_per_s >= wanted {
        return None;
    }
    let limit = format!(
        "the work: {} on {} at {} MHz gives about {:.1} of {wanted} frames a second",
        best.method, best.core, best.clock_mhz, best.frames_per_s
    );
    let method: MethodName = best.method.parse().ok()?;
    let mut changes = Vec::new();
    for (rig, search) in smaller(plan) {
        let (width, height) = (rig.width, rig.height);
        let size = ImageSize { width, height };
        let work = tables.work(best.core, best.clock_mhz, method, size, search.disparities)?;
        if work.frames_per_s >= wanted {
            changes.push(format!(
                "images of {width} x {height} px and {} disparities would give about {:.1}, and reach {:.2} \
                 m within {} %",
                search.disparities,
                work.frames_per_s,
                search.reach(&rig).within_m(plan.wanted.accuracy),
                percent(plan.wanted.accuracy)
            ));
            break;
        }
    }
    let clock = best.clock_mhz * wanted / best.frames_per_s;
    if clock <= FASTEST_MHZ {
        changes.push(format!("{} would need about {clock:.0} MHz for it", best.core));
    }
    Some((limit, changes))
}

/// A share as percent, to two digits behind the point at most.
pub fn percent(share: f64) -> f64 {
    (share * 1e4).round() / 100.0
}
