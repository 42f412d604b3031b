//! Every command that writes files, in two versions.

use crate::{catchment, designs, home};
use std::fs;

const POSES: &str = "poses.csv";
pub(super) const TARGET: &str = "target";

/// A command that writes to [`TARGET`], with a placeholder for the argument that differs between the two
/// versions.
pub(super) struct Writer(pub(super) &'static str, [&'static str; 2]);

pub(super) const WRITERS: [Writer; 35] = [
    Writer("run v.toml --free x --resolution {} --samples 0 -o target", ["6", "7"]),
    Writer("run v.toml --resolution {} --samples 0 -o target.zarr", ["6", "7"]),
    Writer("slices v.toml --resolution {} -o target", ["6", "7"]),
    Writer("sweep v.toml --over cor=0,1 --resolution {} --samples 0 -o target", ["6", "7"]),
    Writer("outcome v.toml --poses poses.csv {} -o target --force", ["", "--json"]),
    Writer("export pyramid.toml --pose {} -o target", ["x=0.1", "x=0.2"]),
    Writer("run v.toml --free x --resolution {} --samples 0 --figures target", ["6", "7"]),
    Writer("run v.toml --free x --method all --boxes 100 --samples 0 --resolution {} -o target", ["2", "3"]),
    Writer("run v.toml --sensitivity --samples {} -o target", ["20", "30"]),
    Writer("run v.toml --free x --converge --samples 0 --time-limit {} -o target", ["20ms", "30ms"]),
    Writer("compare v.toml --methods flood,meyer --resolution {} -o target", ["6", "8"]),
    Writer("reproduce 2.1 {} -o target", ["", "--threads 1"]),
    Writer("trace v.toml --pose {} -o target.svg --force", ["x=0.1", "x=0.2"]),
    Writer("new {} -o target --force", ["cone", "pyramid"]),
    Writer(
        "place socket.obj plug.ply --unit mm --drawn assembled --name {} -o target.toml --force",
        ["a", "b"],
    ),
    Writer(
        "place socket.obj plug.ply --unit mm --drawn assembled {} --figure target.svg --force",
        ["", "--approach=+y"],
    ),
    Writer("report stored --leave-out window {} -o target.html --force", ["--leave-out jams", ""]),
    Writer("export stored {} -o target.vti --force", ["", "--axes x"]),
    Writer("trace v.toml --pose {} -o target.glb --force", ["x=0.1", "x=0.2"]),
    Writer("jams v.toml --examine 0 --motions {} -o target.svg --force", ["20", "30"]),
    Writer("rests v.toml --examine 0 --motions {} -o target.svg --force", ["20", "30"]),
    Writer("window v.toml --motions {} -o target.csv --force", ["20", "30"]),
    Writer("plan v.toml --accuracy x=0.01 --pattern grid --steps {} -o target.csv --force", ["x=3", "x=4"]),
    Writer("validate tried.csv bench.toml --accuracy {} -o target.csv --force", ["x=0.1mm", "x=0.2mm"]),
    Writer(
        "success v.toml --cells 0 --motions 100 --error-sigma {} -o target.svg --force",
        ["x=0.1", "x=0.2"],
    ),
    Writer("friction v.toml --motions 20 --frictions {} -o target.svg --force", ["0.1", "0.2"]),
    Writer("hold v.toml --directions {} -o target.svg --force", ["8", "9"]),
    Writer(
        "chance v.toml --push 1 --map x,pitch --trials 1 --timeout 1 --cells {} -o target.svg --force",
        ["2", "3"],
    ),
    Writer("solids v.toml --slices {} -o target.obj --force", ["3", "4"]),
    Writer("catalog design {} -o target.toml --force", ["cone", "polybot"]),
    Writer("invert v.toml --backing {} -o target.toml --force", ["0.1", "0.2"]),
    Writer("compose region.csv region.csv --frames {} -o target.csv --force", ["own", "world"]),
    Writer("latch --table {} -o target.csv --force", ["", "--json"]),
    Writer("chain chain.toml --chains {} -o target.csv --force", ["5", "6"]),
    Writer("zraa v.toml --aspect-ratio {} -o target.svg --force", ["1", "0.5"]),
];

impl Writer {
    /// The arguments of a version.
    pub(super) fn words(&self, version: usize) -> Vec<String> {
        let line = self.0.replace("{}", self.1[version]);
        line.split_whitespace().map(ToOwned::to_owned).collect()
    }
}

/// A folder with the inputs of the writers.
pub(super) fn furnished(writer: &Writer) -> tempfile::TempDir {
    let home = home();
    for (from, to) in [
        ("pyramid.toml", "pyramid.toml"),
        ("x-face.toml", "x-face.toml"),
        ("bench-pyramid-arc.toml", "bench.toml"),
        ("trials/pyramid-arc.csv", "tried.csv"),
        ("meshes/assembled-socket.obj", "socket.obj"),
        ("meshes/assembled-plug.ply", "plug.ply"),
    ] {
        fs::copy(designs().join(from), home.path().join(to)).unwrap();
    }
    let chain = fs::read_to_string(designs().join("systems/chain.toml")).unwrap();
    fs::write(home.path().join("chain.toml"), chain.replace("../x-face.toml", "x-face.toml")).unwrap();
    fs::write(home.path().join("region.csv"), "x,y\n0,0\n40,0\n40,30\n0,20\n").unwrap();
    fs::write(home.path().join(POSES), "x,pitch\n0.1,0\n0.2,0.1\n9,0\n").unwrap();
    if writer.0.contains("stored") {
        let args = ["run", "v.toml", "--resolution", "6", "--samples", "0", "-o", "stored"];
        assert!(catchment(home.path()).args(args).output().unwrap().status.success());
    }
    home
}
