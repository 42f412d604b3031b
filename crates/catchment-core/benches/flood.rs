//! Flooding: committed designs, the judges beside the fast path, a smooth random landscape of 8 million cells in three
//! and in five dimensions, and scikit-image on the very same landscape.
//!
//! The comparison needs a Python with scikit-image: name it in `CATCHMENT_PYTHON`, or put it into `.venv`. Both sides
//! run on one thread; the fastest of several runs counts, since the machine may be busy.

mod designs;
mod rates;

use catchment_core::contact::Pair;
use catchment_core::design::Alignment;
use catchment_core::exec::Exec;
use catchment_core::landscape::{Grid, Landscape};
use catchment_core::method::flood::{self, DrainageRule, FloodSettings, Flooding, brute, meyer};
use catchment_core::pose::{Dof, Mount};
use designs::pair;
use peak_alloc::PeakAlloc;
use rates::Rates;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

/// Grid on which the judges are measured against the fast path.
const SMALL: usize = 24;

#[expect(clippy::print_stdout, reason = "a bench prints its figures")]
fn main() {
    let mut rates = Rates::of("flood");
    for smooth in [SPACE, FIVE] {
        let (landscape, alignment) = smooth.landscape();
        for threads in [1, 2] {
            let name = format!("{}-D smooth noise, {threads} threads", smooth.axes);
            rates.measure(
                &name,
                "floods of cells",
                landscape.heights.len(),
                &mut || {
                    let tree = Smooth::flood(&landscape, &alignment, threads).hierarchy.tree;
                    assert_eq!(tree.minima.len(), tree.links.len() + 1, "a tree");
                },
                None,
            );
        }
    }
    // Heights included: the whole method.
    for (name, cells) in [("v-face", 100), ("pyramid", 8), ("pyramid", 12)] {
        let pair = pair(&format!("{name}.toml"));
        let grid = Grid::over(&pair.alignment, |_| cells);
        let accept = || {
            let result =
                flood::accept(&pair, &grid, &FloodSettings::default(), &Exec::new()).expect("flooded");
            let share = result.counts()[0] as f64 / grid.len() as f64;
            // Loose: a bench guards against computing nothing or everything, the tests hold the numbers.
            assert!((0.05..0.9).contains(&share), "{name}: {share} of the box accepted");
        };
        let name = format!("with heights, {name}, {cells} cells per axis");
        rates.measure(&name, "floods of cells", grid.len(), &mut || accept(), None);
    }
    for rule in [DrainageRule::Lowest, DrainageRule::Steepest] {
        let pair = pair("pyramid.toml");
        let landscape = landscape(&pair, 12);
        let settings = FloodSettings { rule, ..FloodSettings::default() };
        let flood = || {
            flood::flood(&landscape, &pair.alignment, &|_| true, &settings, &Exec::new()).expect("flooded")
        };
        let name = format!("to the {rule:?} neighbour, pyramid, 12 cells per axis");
        rates.measure(&name, "floods of cells", landscape.heights.len(), &mut || drop(flood()), None);
    }
    let small = pair("v-face.toml");
    let landscape = landscape(&small, SMALL);
    let settings = FloodSettings::default();
    let shape = landscape.grid.shape();
    rates.measure(
        "judged, v-face, 24 cells per axis",
        "floods of cells",
        landscape.heights.len(),
        &mut || {
            drop(
                flood::flood(&landscape, &small.alignment, &|_| true, &settings, &Exec::new())
                    .expect("flooded"),
            );
        },
        Some(&mut || {
            drop((brute::tree(&shape, &landscape.heights), brute::basins(&shape, &landscape.heights)));
        }),
    );
    let plane = pair("v-face.toml");
    let landscape = self::landscape(&plane, 100);
    let settings = meyer::MeyerSettings::default();
    rates.measure(
        "Meyer's queue, v-face, 100 cells per axis",
        "floods of cells",
        landscape.heights.len(),
        &mut || {
            let result = meyer::accept(&landscape, &plane.alignment, &|_| true, &settings, &Exec::new())
                .expect("flooded");
            let share = result.acceptance.counts()[0] as f64 / landscape.heights.len() as f64;
            assert!((0.05..0.9).contains(&share), "{share} of the box accepted");
        },
        None,
    );
    rates.finish();
    if std::env::args().any(|argument| argument == "--bench") {
        for smooth in [SPACE, FIVE] {
            println!("{}", against_scikit_image(smooth));
        }
    }
}

fn landscape(pair: &Pair, cells: usize) -> Landscape {
    let grid = Grid::over(&pair.alignment, |_| cells);
    Landscape::compute(pair, &grid, &Exec::new()).expect("heights")
}

/// A cube of smooth random heights: white noise, averaged three times over a box along every axis.
#[derive(Debug, Clone, Copy)]
struct Smooth {
    axes: usize,
    cells: usize,
    /// Cells of the box: σ² = (box² − 1)/4 of the bell curve that three averages make.
    window: usize,
}

/// σ = 8 cells.
const SPACE: Smooth = Smooth { axes: 3, cells: 200, window: 16 };
/// σ = 1.5 cells; nearly every cell lies beside a border.
const FIVE: Smooth = Smooth { axes: 5, cells: 24, window: 3 };

impl Smooth {
    fn landscape(self) -> (Landscape, Alignment) {
        let dofs = Dof::ALL.into_iter().take(self.axes);
        let alignment = Alignment::new(dofs.collect(), Mount::X);
        let grid = Grid::over(&alignment, |_| self.cells);
        let mut state = 1u64;
        // A linear congruential generator (Knuth, MMIX); its upper bits are good enough for noise.
        let mut noise = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f32 / (1u64 << 24) as f32
        };
        let mut heights: Vec<f32> = (0..grid.len()).map(|_| noise()).collect();
        let mut line = vec![0.0f32; self.cells];
        for axis in 0..self.axes {
            let stride = self.cells.pow(axis as u32);
            for first in (0..heights.len()).filter(|at| (at / stride).is_multiple_of(self.cells)) {
                for _ in 0..3 {
                    for (k, entry) in line.iter_mut().enumerate() {
                        let near = |j: usize| heights[first + (k + j) % self.cells * stride];
                        *entry = (0..self.window).map(near).sum::<f32>() / self.window as f32;
                    }
                    for (k, entry) in line.iter().enumerate() {
                        heights[first + k * stride] = *entry;
                    }
                }
            }
        }
        (Landscape { grid, heights }, alignment)
    }

    fn flood(landscape: &Landscape, alignment: &Alignment, threads: usize) -> Flooding {
        let exec = Exec::new().with_threads(threads).expect("threads");
        flood::flood(landscape, alignment, &|_| true, &FloodSettings::default(), &exec).expect("flooded")
    }
}

/// Both on the very same heights, in the same run.
fn against_scikit_image(smooth: Smooth) -> String {
    const ROUNDS: usize = 5;
    let (landscape, alignment) = smooth.landscape();
    let cells = landscape.heights.len() as f64;
    let mut fastest = f64::INFINITY;
    let mut minima = 0;
    for _ in 0..ROUNDS {
        let start = Instant::now();
        minima = Smooth::flood(&landscape, &alignment, 1).hierarchy.tree.minima.len();
        fastest = fastest.min(start.elapsed().as_secs_f64());
    }
    let ours = format!(
        "{}-D, {} cells, 1 thread: {fastest:.3} s, {:.1} Mcell/s, {minima} minima",
        smooth.axes,
        landscape.heights.len(),
        cells / fastest / 1e6
    );
    match scikit_image(&landscape, smooth) {
        Err(reason) => format!("{ours}\n  scikit-image: skipped, {reason}"),
        Ok(lines) => {
            let mut lines = lines.lines();
            let version = lines.next().unwrap_or_default();
            let mut text = ours;
            for line in lines {
                let fields: Vec<&str> = line.split_whitespace().collect();
                let [neighbours, basins, seconds] = fields[..] else { continue };
                let seconds: f64 = seconds.parse().expect("seconds");
                let times = seconds / fastest;
                let what = format!("scikit-image {version}, connectivity {neighbours}");
                text = format!("{text}\n  {what}: {seconds:.3} s, {basins} basins: {times:.1} times as long");
            }
            text
        }
    }
}

fn scikit_image(landscape: &Landscape, smooth: Smooth) -> Result<String, String> {
    let crate_root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let python = std::env::var_os("CATCHMENT_PYTHON")
        .map_or_else(|| crate_root.join("../../.venv/bin/python"), PathBuf::from);
    let folder = tempfile::tempdir().map_err(|e| e.to_string())?;
    let path = folder.path().join("heights.f32");
    let bytes: Vec<u8> = landscape.heights.iter().flat_map(|h| h.to_le_bytes()).collect();
    std::fs::write(&path, bytes).map_err(|e| e.to_string())?;
    let output = Command::new(&python)
        .arg(crate_root.join("benches/peers/watershed.py"))
        .arg(&path)
        .args([smooth.cells.to_string(), smooth.axes.to_string()])
        .output()
        .map_err(|e| format!("{}: {e}", python.display()))?;
    if !output.status.success() {
        let defect = String::from_utf8_lossy(&output.stderr);
        return Err(defect.lines().last().unwrap_or("it failed").to_owned());
    }
    String::from_utf8(output.stdout).map_err(|e| e.to_string())
}
