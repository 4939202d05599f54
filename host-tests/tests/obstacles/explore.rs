use super::support::*;
use stereopsis::obstacles::*;
use stereopsis_host::scene::RobotScene;
#[test]
fn explore() {
    use RobotScene::*;
    for s in [
        Corridor,
        Street,
        Sky,
        Table,
        Poles,
        WhiteWall,
        BoxAt(500),
        BoxAt(800),
        BoxAt(1000),
        BoxAt(1300),
        BoxAt(1600),
        BoxAt(2000),
    ] {
        for noise in [0.0, 3.0] {
            let (l, r) = s.scene(1).render();
            let mut c = Cameras::new(&s.scene(1));
            let mut tally = std::collections::BTreeMap::<String, usize>::new();
            let mut text = String::new();
            for n in 0..20 {
                let f = c.frame(&noisy(&l, noise, 1.0, 2 * n), &noisy(&r, noise, 1.0, 2 * n + 1));
                let v = f.finder.as_mut_view();
                let d = DriveRule::new(DriveConfig::default()).decide(&v, 500);
                let d = match d.decision {
                    Decision::Slow(_) => "slow".into(),
                    Decision::Stop(_) => "stop".into(),
                    d => format!("{d:?}"),
                };
                *tally.entry(d).or_default() += 1;
                if n == 0 {
                    let g = v.ground();
                    text = format!(
                        "{:?} {:?}\n",
                        g.map(|g| (g.height_mm, g.pitch_rad(), g.variance)),
                        v.blind()
                    );
                    for i in 0..v.sectors() {
                        let s = v.sector(i);
                        text += &format!(
                            " {:?}/{}/{}/{}/{}/s{}",
                            s.state, s.depth_mm, s.sigma_mm, s.pixels, s.height_mm, s.seen_mm
                        );
                    }
                }
            }
            println!("{s:?} noise {noise}: {tally:?} {text}");
        }
    }
}
