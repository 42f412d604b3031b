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
    cargo bench --locked -p catchment -- {{ filter }}

# the program, optimised: just run run designs/v-face.toml
run *arguments:
    cargo run --locked --release -- {{ arguments }}

# the library's documentation in a browser
docs:
    cargo doc --locked --workspace --no-deps --all-features --open

# fuzz a reader: design, stl, poses, lines, report, zarr, requirement or resolution: just fuzz stl 600 (needs nightly and cargo-fuzz)
fuzz target='design' seconds='60':
    mkdir -p fuzz/findings/{{ target }}
    cargo +nightly fuzz run {{ target }} fuzz/findings/{{ target }} fuzz/corpus/{{ target }} -- -max_total_time={{ seconds }} -rss_limit_mb=2048 -malloc_limit_mb=256 {{ if target == 'design' { '-dict=fuzz/design.dict' } else { '' } }}

# kill the program at random moments while it writes; what is there must be old or new, complete
kills count='300':
    CATCHMENT_KILLS={{ count }} cargo test --locked -p catchment-cli --test cli killed -- --nocapture

# accept the program's new output after reading it: runs the snapshot tests, shows what changed
golden:
    INSTA_UPDATE=always cargo test --locked -p catchment-cli --test cli
    git diff --stat -- '*.snap' designs/schema.json
