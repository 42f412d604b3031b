use catchment::acceptance::*;
use catchment::connector::*;
use catchment::contact::*;
use catchment::design::*;
use catchment::exec::Exec;
use catchment::landscape::*;
use catchment::method::descent;
use catchment::pose::*;
use std::time::Instant;
fn design(family: Family, ar: f64, cor: f64, rho: f64, free: DofSet) -> Design {
    let mount = if family.is_planar() { Mount::Y } else { Mount::X };
    let mut alignment = Alignment::new(free, mount);
    alignment.center_of_rotation = cor;
    alignment.rotation_length = rho;
    let mut spec = FamilySpec::new(family);
    spec.aspect_ratio = ar;
    Design { name: "t".into(), connector: ConnectorSpec::Family(spec), width: 1.0, unit: None, alignment }
}
fn main() {
    let what = std::env::args().nth(1).unwrap_or("trials".into());
    let step: f64 = std::env::args().nth(2).map_or(0.02, |s| s.parse().unwrap());
    let settings = descent::Settings { step, ..Default::default() };
    if what == "trials" {
        for name in
            ["pyramid-ar0.5-cor0.5-5d", "pyramid-ar1-cor0-xyyaw", "x-face-3d-cor0-xy", "x-face-3d-cor0.5-5d"]
        {
            let text = std::fs::read_to_string(format!("reference/mujoco/{name}.json")).unwrap();
            let v: serde_json::Value = serde_json::from_str(&text).unwrap();
            let family = if v["family"] == "pyramid" { Family::Pyramid } else { Family::XFace3d };
            let free: DofSet = v["free"]
                .as_array()
                .unwrap()
                .iter()
                .map(|d| Dof::ALL.into_iter().find(|x| x.name() == d.as_str().unwrap()).unwrap())
                .collect();
            let d = design(
                family,
                v["aspect_ratio"].as_f64().unwrap(),
                v["center_of_rotation"].as_f64().unwrap(),
                v["rotation_length"].as_f64().unwrap(),
                free,
            );
            let c = Connector::build(&d).unwrap();
            let pair = Pair::new(&c, &d.alignment);
            let mut poses = vec![];
            let mut want = vec![];
            for p in v["poses"].as_array().unwrap() {
                let p = p.as_array().unwrap();
                poses.push(PoseError::from_array(std::array::from_fn(|k| p[k].as_f64().unwrap())));
                want.push(p[5].as_str().unwrap().to_string());
            }
            let t = Instant::now();
            if let Ok(k) = std::env::var("ONLY") {
                let k: usize = k.parse().unwrap();
                let s = descent::Settings {
                    max_steps: std::env::var("MAXS").map_or(20000, |x| x.parse().unwrap()),
                    ..settings.clone()
                };
                println!("{:?}", descent::outcome(&pair, &poses[k], &s));
                return;
            }
            let (a, ends) = descent::run(
                &pair,
                Domain::Poses(poses.clone()),
                &settings,
                &Exec::new().with_threads(1).unwrap(),
            )
            .unwrap();
            let dt = t.elapsed().as_secs_f64();
            let mut agree = 0;
            let mut total = 0;
            let mut und = 0;
            for (k, o) in a.outcomes.iter().enumerate() {
                if *o == Outcome::Undecided || want[k] == "undecided" {
                    und += 1;
                    if und < 4 {
                        println!("  undecided {k} end {:?}", ends[k].error.to_array());
                    }
                    continue;
                }
                total += 1;
                if (*o == Outcome::Aligned) == (want[k] == "aligned") {
                    agree += 1
                } else {
                    println!(
                        "  {k} want {} got {} {:?} end {:?}",
                        want[k],
                        o.name(),
                        poses[k].to_array(),
                        ends[k].error.to_array()
                    );
                }
            }
            println!(
                "{name}: {agree}/{total} = {:.4}, undecided {und}, {:.3} ms/pose counts {:?}",
                agree as f64 / total as f64,
                dt * 1e3 / a.outcomes.len() as f64,
                a.counts()
            );
        }
    } else if what == "planar" {
        for (f, ar, cor, want) in [
            (Family::XFace, 1.0, 0.5, 3.85),
            (Family::XFace, 0.5, -0.5, 1.95),
            (Family::VFace, 1.0, 0.0, 2.39),
            (Family::VFace, 0.5, -0.5, 1.28),
            (Family::XFace, 2.0, 1.0, 3.71),
        ] {
            let d = design(f, ar, cor, 1.0, [Dof::X, Dof::Pitch].into_iter().collect());
            let c = Connector::build(&d).unwrap();
            let pair = Pair::new(&c, &d.alignment);
            let n: usize = std::env::args().nth(3).map_or(100, |s| s.parse().unwrap());
            let grid = Grid::over(&d.alignment, |_| n);
            let m = grid.cell_measure();
            let t = Instant::now();
            if std::env::var("SLOW").is_ok() {
                let mut all = vec![];
                for k in 0..grid.len() {
                    let t = Instant::now();
                    let e = descent::outcome(&pair, &grid.pose(k), &settings);
                    all.push((t.elapsed().as_secs_f64() * 1e3, k, grid.pose(k).to_array(), e));
                }
                all.sort_by(|a, b| b.0.total_cmp(&a.0));
                for a in &all[..5] {
                    println!("{a:?}");
                }
                continue;
            }
            let (a, _) = descent::run(&pair, Domain::Grid(grid), &settings, &Exec::new()).unwrap();
            println!(
                "{} ar {ar} cor {cor}: {:.4} want {want} counts {:?} {:.2}s",
                f.name(),
                a.counts()[0] as f64 * m,
                a.counts(),
                t.elapsed().as_secs_f64()
            );
            if std::env::args().nth(4).is_some() {
                for r in (0..n).rev() {
                    let s: String =
                        (0..n).map(|k| [' ', 'A', '.', '_', '?'][a.outcomes[r * n + k] as usize]).collect();
                    println!("{s}");
                }
            }
        }
    } else if what == "one" {
        let d = design(Family::XFace, 0.5, -0.5, 1.0, [Dof::X, Dof::Pitch].into_iter().collect());
        let c = Connector::build(&d).unwrap();
        let pair = Pair::new(&c, &d.alignment);
        let s = descent::Settings { max_steps: 400, ..settings.clone() };
        println!(
            "{:?}",
            descent::outcome(
                &pair,
                &PoseError { x: -0.16666666666666663, pitch: -1.5184364492350666, ..Default::default() },
                &s
            )
        );
    } else if what == "slow" {
        let (f, ar, cor, rho) = match std::env::args().nth(3).as_deref() {
            Some("x3") => (Family::XFace3d, 0.57735, 0.5, 0.5),
            Some("xf") => (Family::XFace, 1.0, 0.5, 1.0),
            _ => (Family::VFace, 1.0, 0.0, 1.0),
        };
        let free = if f.is_planar() { [Dof::X, Dof::Pitch].into_iter().collect() } else { DofSet::ALL };
        let d = design(f, ar, cor, rho, free);
        let c = Connector::build(&d).unwrap();
        let pair = Pair::new(&c, &d.alignment);
        let s = descent::Settings {
            max_steps: std::env::var("MAXS").map_or(20000, |x| x.parse().unwrap()),
            ..settings.clone()
        };
        let mut seed = 12345u64;
        let mut r = move || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            ((seed >> 33) as f64) / (1u64 << 31) as f64
        };
        let mut all = vec![];
        for k in 0..300 {
            let e: [f64; 5] = std::array::from_fn(|i| {
                let dof = Dof::ALL[i];
                (2.0 * r() - 1.0) * d.alignment.half_range(dof)
            });
            let e = PoseError::from_array(e);
            if let Ok(o) = std::env::var("ONLY") {
                if o.parse::<usize>().unwrap() != k {
                    continue;
                }
            }
            let t = Instant::now();
            let end = descent::outcome(&pair, &e, &s);
            all.push((t.elapsed().as_secs_f64() * 1e3, k, e.to_array(), end.outcome, end.error.to_array()));
        }
        all.sort_by(|a, b| b.0.total_cmp(&a.0));
        for a in &all[..all.len().min(6)] {
            println!("{a:?}");
        }
        println!("total {:.1} ms for {}", all.iter().map(|a| a.0).sum::<f64>(), all.len());
    }
}
