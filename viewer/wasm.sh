#!/usr/bin/env bash
# The core of the library as WebAssembly, for the pages: crates/catchment-wasm ──▶ bundle/motions.wasm.z
#
#     viewer/wasm.sh
#
# Another folder, or another compiler, writes other bytes. So the tests compare the motions of the module with those of the program, not its bytes
# (tests/motions.test.mjs, tests/page.test.mjs).
# The standard library for wasm32-unknown-unknown is compiled with it: by a target of rustup, or from its source, which is rustup's rust-src or
# Debian's package of the very same version of Rust (it is fetched with apt-get, unpacked into target/ and not installed).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

bundle=crates/catchment-report/src/page/bundle/motions.wasm.z
work=$PWD/target/wasm
target=wasm32-unknown-unknown
cannot() { printf 'wasm: %s\n' "$1" >&2; exit 3; }
mkdir -p "$work"

version=$(rustc --version | cut -d ' ' -f 2)
# One Rust, one module: another compiler writes other bytes.
[[ $version == "$(sed -n 's/^rust-version = "\(.*\)"/\1/p' Cargo.toml)"* ]] || cannot "it is built with the Rust that Cargo.toml names; this is $version"

source=$(rustc --print sysroot)/lib/rustlib/src/rust/library
if [[ ! -f $source/Cargo.lock ]]; then
    source=$(find "$work" -maxdepth 5 -path '*/library' -path "*rustc-$version*" | head -n 1)
fi
if [[ -z $source ]]; then
    command -v apt-get >/dev/null || cannot "the source of the standard library is missing: rustup component add rust-src"
    echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] http://deb.debian.org/debian trixie-backports main" >"$work/sources.list"
    mkdir -p "$work"/apt/{lists,archives}/partial
    apt=(-o "Dir::Etc::sourcelist=$work/sources.list" -o Dir::Etc::sourceparts=/nonexistent -o "Dir::State::lists=$work/apt/lists"
        -o "Dir::Cache=$work/apt" -o APT::Sandbox::User=root -o Acquire::Languages=none)
    apt-get "${apt[@]}" -qq update >/dev/null 2>&1 || cannot 'Debian cannot be reached for the source of the standard library'
    package=$(apt-cache "${apt[@]}" madison rust-src | awk -v v="$version+" 'index($3, v) == 1 { print $3; exit }')
    [[ -n $package ]] || cannot "Debian has no source of the standard library of Rust $version any more: rustup component add rust-src"
    (cd "$work" && apt-get "${apt[@]}" -qq download "rust-src=$package" && dpkg -x rust-src_*.deb .) || cannot 'its package cannot be had'
    source=$work/usr/src/rustc-$version/library
fi

# No path of this machine stands in the module.
home=${CARGO_HOME:-$HOME/.cargo}
export RUSTFLAGS="--remap-path-prefix=$source=std --remap-path-prefix=$PWD=catchment --remap-path-prefix=$home=cargo"
export RUSTC_BOOTSTRAP=1 __CARGO_TESTS_ONLY_SRC_ROOT=$source CARGO_TARGET_DIR=$work
cargo build --quiet --locked -Zbuild-std=std,panic_abort --target "$target" -p catchment-wasm --profile page ||
    cannot 'the module does not build here'
built=$work/$target/page/catchment_wasm.wasm

node -e '
    const { readFileSync, writeFileSync } = require("fs"), { deflateSync } = require("zlib"), [built, lies] = process.argv.slice(1);
    const module = readFileSync(built), packed = deflateSync(module, { level: 9 });
    writeFileSync(lies, packed);
    console.log(`${lies}: ${module.length} bytes, ${packed.length} packed`);
' "$built" "$bundle"
