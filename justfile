# Recipes for people who work on the program. `just` lists them; `./check` needs none of this.

[private]
default:
    @just --list --unsorted

# all that must hold before a change goes in (= CI)
check:
    ./check

# tests, or those whose name contains a word: just test onaa
test *filter:
    cargo nextest run --locked --workspace --all-features {{ filter }}
    cargo test --locked --workspace --all-features --doc

# rates beside the judges and beside stored ones; every bench asserts its result; just bench --store keeps new ones
bench *filter:
    cargo bench --locked -p catchment-core -- {{ filter }}

# the program, optimised: just run run designs/v-face.toml
run *arguments:
    cargo run --locked --release -- {{ arguments }}

# the Python wheel of this system, into target/wheels
wheel:
    crates/catchment-py/wheel

# the library's documentation in a browser
docs:
    cargo doc --locked --workspace --no-deps --all-features --open

# the pages that the program writes, and the whole as a site in target/site (needs mkdocs-material)
site:
    cargo build --locked
    python3 site/reference.py target/debug/catchment
    python3 site/gallery.py --page
    python3 site/transcripts.py target/debug/catchment
    mkdocs build --strict

# measures the designs of the gallery again: just gallery peg-in-hole
gallery *designs:
    cargo build --locked --release
    python3 site/gallery.py target/release/catchment {{ designs }}

# draws the pictures of docs/ again, all or those whose names begin so: just pictures friction
pictures *names:
    cargo build --locked --release
    python3 site/pictures.py target/release/catchment {{ names }}

# the archive of a release, made and tried
archive:
    release/build

# fuzz one of the targets of fuzz/src/main.rs, which have the names of fuzz/corpus: just fuzz stl 600
fuzz target='design' seconds='60':
    fuzz/run {{ seconds }} {{ target }}

# spoilt designs, tables, results and command lines through the optimised program, under a limit of 1 GiB: just storm 50000 --seed 7
storm count='3000' *options:
    cargo build --locked --release
    python3 tests/storm.py target/release/catchment {{ count }} {{ options }}

# what every command takes of the memory on every design, beside what it expects
memory *designs:
    cargo build --locked --release
    python3 tests/memory.py target/release/catchment {{ designs }}

# builds the release in two other folders and compares them, byte for byte
reproducible:
    tests/reproducible

# known weaknesses of what is depended on: crates by the RustSec database, which is fetched, npm's and PyPI's packages by their registries
advisories:
    test -d ~/.cargo/advisory-db || git clone --quiet https://github.com/rustsec/advisory-db ~/.cargo/advisory-db
    git -C ~/.cargo/advisory-db pull --quiet --ff-only
    python3 tests/advisories.py ~/.cargo/advisory-db
    cd viewer && npm audit
    uvx pip-audit -r tests/requirements.txt -r site/requirements.txt

# the bill of materials of the program (CycloneDX), beside its Cargo.toml; needs `cargo install cargo-cyclonedx`
sbom:
    cargo cyclonedx --manifest-path crates/catchment-cli/Cargo.toml --all-features --format json --describe binaries

# end the program at random moments while it writes, and refuse it memory at any; what is there must be old or new, complete
kills count='300':
    CATCHMENT_KILLS={{ count }} cargo test --locked -p catchment-cli --test cli kills:: -- --nocapture

# accept the program's new output after reading it: runs the snapshot tests, shows what changed
golden:
    INSTA_UPDATE=always cargo test --locked -p catchment-cli --test cli
    git diff --stat -- '*.snap' designs/schema.json
