//! Every command that writes, in two versions.

use crate::{catchment, designs, home};
use std::fs;

const POSES: &str = "poses.csv";
pub(super) const TARGET: &str = "target";

/// A command that writes to [`TARGET`], in two versions.
pub(super) struct Writer {
    pub(super) name: &'static str,
    pub(super) versions: [&'static [&'static str]; 2],
}

pub(super) const WRITERS: [Writer; 35] = [
    Writer {
        name: "run -o",
        versions: [
            &["run", "v.toml", "--free", "x", "--resolution", "6", "--samples", "0", "-o", TARGET],
            &["run", "v.toml", "--free", "x", "--resolution", "7", "--samples", "0", "-o", TARGET],
        ],
    },
    Writer {
        name: "run -o NAME.zarr",
        versions: [
            &["run", "v.toml", "--resolution", "6", "--samples", "0", "-o", "target.zarr"],
            &["run", "v.toml", "--resolution", "7", "--samples", "0", "-o", "target.zarr"],
        ],
    },
    Writer {
        name: "slices -o",
        versions: [
            &["slices", "v.toml", "--resolution", "6", "-o", TARGET],
            &["slices", "v.toml", "--resolution", "7", "-o", TARGET],
        ],
    },
    Writer {
        name: "sweep -o",
        versions: [
            &["sweep", "v.toml", "--over", "cor=0,1", "--resolution", "6", "--samples", "0", "-o", TARGET],
            &["sweep", "v.toml", "--over", "cor=0,1", "--resolution", "7", "--samples", "0", "-o", TARGET],
        ],
    },
    Writer {
        name: "outcome -o --force",
        versions: [
            &["outcome", "v.toml", "--poses", POSES, "-o", TARGET, "--force"],
            &["outcome", "v.toml", "--poses", POSES, "--json", "-o", TARGET, "--force"],
        ],
    },
    Writer {
        name: "export -o",
        versions: [
            &["export", "pyramid.toml", "--pose", "x=0.1", "-o", TARGET],
            &["export", "pyramid.toml", "--pose", "x=0.2", "-o", TARGET],
        ],
    },
    Writer {
        name: "run --figures",
        versions: [
            &["run", "v.toml", "--resolution", "6", "--samples", "0", "--figures", TARGET],
            &["run", "v.toml", "--resolution", "7", "--samples", "0", "--figures", TARGET],
        ],
    },
    Writer {
        name: "run --method all -o",
        versions: [
            &["run", "v.toml", "--free", "x", "--method", "all", "--resolution", "6", "-o", TARGET],
            &["run", "v.toml", "--free", "x", "--method", "all", "--resolution", "7", "-o", TARGET],
        ],
    },
    Writer {
        name: "run --sensitivity -o",
        versions: [
            &["run", "v.toml", "--sensitivity", "--samples", "20", "-o", TARGET],
            &["run", "v.toml", "--sensitivity", "--samples", "30", "-o", TARGET],
        ],
    },
    Writer {
        name: "run --converge -o",
        versions: [
            &["run", "v.toml", "--free", "x", "--converge", "--time-limit", "100ms", "-o", TARGET],
            &["run", "v.toml", "--free", "x", "--converge", "--time-limit", "150ms", "-o", TARGET],
        ],
    },
    Writer {
        name: "compare -o",
        versions: [
            &["compare", "v.toml", "--methods", "flood,meyer", "--resolution", "6", "-o", TARGET],
            &["compare", "v.toml", "--methods", "flood,meyer", "--resolution", "8", "-o", TARGET],
        ],
    },
    Writer {
        name: "reproduce -o",
        versions: [
            &["reproduce", "2.1", "-o", TARGET],
            &["reproduce", "2.1", "--threads", "1", "-o", TARGET],
        ],
    },
    Writer {
        name: "trace -o --force",
        versions: [
            &["trace", "v.toml", "--pose", "x=0.1", "-o", "target.svg", "--force"],
            &["trace", "v.toml", "--pose", "x=0.2", "-o", "target.svg", "--force"],
        ],
    },
    Writer {
        name: "new -o --force",
        versions: [&["new", "cone", "-o", TARGET, "--force"], &["new", "pyramid", "-o", TARGET, "--force"]],
    },
    Writer {
        name: "place -o --force",
        versions: [
            &[
                "place",
                "socket.obj",
                "plug.ply",
                "--unit",
                "mm",
                "--drawn",
                "assembled",
                "--name",
                "a",
                "-o",
                "target.toml",
                "--force",
            ],
            &[
                "place",
                "socket.obj",
                "plug.ply",
                "--unit",
                "mm",
                "--drawn",
                "assembled",
                "--name",
                "b",
                "-o",
                "target.toml",
                "--force",
            ],
        ],
    },
    Writer {
        name: "place --figure --force",
        versions: [
            &[
                "place",
                "socket.obj",
                "plug.ply",
                "--unit",
                "mm",
                "--drawn",
                "assembled",
                "--figure",
                "target.svg",
                "--force",
            ],
            &[
                "place",
                "socket.obj",
                "plug.ply",
                "--unit",
                "mm",
                "--drawn",
                "assembled",
                "--approach=+y",
                "--figure",
                "target.svg",
                "--force",
            ],
        ],
    },
    Writer {
        name: "report -o --force",
        versions: [
            &[
                "report",
                "stored",
                "--leave-out",
                "window",
                "--leave-out",
                "jams",
                "-o",
                "target.html",
                "--force",
            ],
            &["report", "stored", "--leave-out", "window", "-o", "target.html", "--force"],
        ],
    },
    Writer {
        name: "export -o NAME.vti --force",
        versions: [
            &["export", "stored", "-o", "target.vti", "--force"],
            &["export", "stored", "--axes", "x", "-o", "target.vti", "--force"],
        ],
    },
    Writer {
        name: "trace -o NAME.glb --force",
        versions: [
            &["trace", "v.toml", "--pose", "x=0.1", "-o", "target.glb", "--force"],
            &["trace", "v.toml", "--pose", "x=0.2", "-o", "target.glb", "--force"],
        ],
    },
    Writer {
        name: "jams -o --force",
        versions: [
            &["jams", "v.toml", "--examine", "0", "--motions", "20", "-o", "target.svg", "--force"],
            &["jams", "v.toml", "--examine", "0", "--motions", "30", "-o", "target.svg", "--force"],
        ],
    },
    Writer {
        name: "rests -o --force",
        versions: [
            &["rests", "v.toml", "--examine", "0", "--motions", "20", "-o", "target.svg", "--force"],
            &["rests", "v.toml", "--examine", "0", "--motions", "30", "-o", "target.svg", "--force"],
        ],
    },
    Writer {
        name: "window -o --force",
        versions: [
            &["window", "v.toml", "--motions", "20", "-o", "target.csv", "--force"],
            &["window", "v.toml", "--motions", "30", "-o", "target.csv", "--force"],
        ],
    },
    Writer {
        name: "plan -o --force",
        versions: [
            &[
                "plan",
                "v.toml",
                "--accuracy",
                "x=0.01",
                "--pattern",
                "grid",
                "--steps",
                "x=3",
                "-o",
                "target.csv",
                "--force",
            ],
            &[
                "plan",
                "v.toml",
                "--accuracy",
                "x=0.01",
                "--pattern",
                "grid",
                "--steps",
                "x=4",
                "-o",
                "target.csv",
                "--force",
            ],
        ],
    },
    Writer {
        name: "validate -o --force",
        versions: [
            &["validate", "tried.csv", "bench.toml", "--accuracy", "x=0.1 mm", "-o", "target.csv", "--force"],
            &["validate", "tried.csv", "bench.toml", "--accuracy", "x=0.2 mm", "-o", "target.csv", "--force"],
        ],
    },
    Writer {
        name: "success -o --force",
        versions: [
            &[
                "success",
                "v.toml",
                "--cells",
                "0",
                "--motions",
                "100",
                "--error-sigma",
                "x=0.1",
                "-o",
                "target.svg",
                "--force",
            ],
            &[
                "success",
                "v.toml",
                "--cells",
                "0",
                "--motions",
                "100",
                "--error-sigma",
                "x=0.2",
                "-o",
                "target.svg",
                "--force",
            ],
        ],
    },
    Writer {
        name: "friction -o --force",
        versions: [
            &["friction", "v.toml", "--motions", "20", "--frictions", "0.1", "-o", "target.svg", "--force"],
            &["friction", "v.toml", "--motions", "20", "--frictions", "0.2", "-o", "target.svg", "--force"],
        ],
    },
    Writer {
        name: "hold -o --force",
        versions: [
            &["hold", "v.toml", "--directions", "8", "-o", "target.svg", "--force"],
            &["hold", "v.toml", "--directions", "9", "-o", "target.svg", "--force"],
        ],
    },
    Writer {
        name: "chance -o --force",
        versions: [
            &[
                "chance",
                "v.toml",
                "--push",
                "1",
                "--map",
                "x,pitch",
                "--trials",
                "1",
                "--timeout",
                "1",
                "--cells",
                "2",
                "-o",
                "target.svg",
                "--force",
            ],
            &[
                "chance",
                "v.toml",
                "--push",
                "1",
                "--map",
                "x,pitch",
                "--trials",
                "1",
                "--timeout",
                "1",
                "--cells",
                "3",
                "-o",
                "target.svg",
                "--force",
            ],
        ],
    },
    Writer {
        name: "solids -o --force",
        versions: [
            &["solids", "v.toml", "--slices", "3", "-o", "target.obj", "--force"],
            &["solids", "v.toml", "--slices", "4", "-o", "target.obj", "--force"],
        ],
    },
    Writer {
        name: "catalog design -o --force",
        versions: [
            &["catalog", "design", "cone", "-o", "target.toml", "--force"],
            &["catalog", "design", "polybot", "-o", "target.toml", "--force"],
        ],
    },
    Writer {
        name: "invert -o --force",
        versions: [
            &["invert", "v.toml", "--backing", "0.1", "-o", "target.toml", "--force"],
            &["invert", "v.toml", "--backing", "0.2", "-o", "target.toml", "--force"],
        ],
    },
    Writer {
        name: "compose -o --force",
        versions: [
            &["compose", "region.csv", "region.csv", "--frames", "own", "-o", "target.csv", "--force"],
            &["compose", "region.csv", "region.csv", "--frames", "world", "-o", "target.csv", "--force"],
        ],
    },
    Writer {
        name: "latch -o --force",
        versions: [
            &["latch", "--table", "-o", "target.csv", "--force"],
            &["latch", "--table", "--json", "-o", "target.csv", "--force"],
        ],
    },
    Writer {
        name: "chain -o --force",
        versions: [
            &["chain", "chain.toml", "--chains", "5", "-o", "target.csv", "--force"],
            &["chain", "chain.toml", "--chains", "6", "-o", "target.csv", "--force"],
        ],
    },
    Writer {
        name: "zraa -o --force",
        versions: [
            &["zraa", "v.toml", "--aspect-ratio", "1", "-o", "target.svg", "--force"],
            &["zraa", "v.toml", "--aspect-ratio", "0.5", "-o", "target.svg", "--force"],
        ],
    },
];

/// A folder with what the writers read.
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
    if writer.versions[0].contains(&"stored") {
        let args = ["run", "v.toml", "--resolution", "6", "--samples", "0", "-o", "stored"];
        assert!(catchment(home.path()).args(args).output().unwrap().status.success());
    }
    home
}
