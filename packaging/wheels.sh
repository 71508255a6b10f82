#!/usr/bin/env bash
# Builds a wheel for each target, which serves Python 3.11 and all newer.
#
#   packaging/wheels.sh TARGET...
#
# Writes to target/packages.
set -euo pipefail
cd "$(dirname "$0")/.."
# As in archives.sh.
export RUSTFLAGS="--remap-path-prefix=${CARGO_HOME:-$HOME/.cargo}=cargo"
flags="-Cllvm-args=--inline-threshold=10 --inlinehint-threshold=25"

# maturin takes along the licences that it finds there.
trap 'rm -f crates/python/LICENSE-*' EXIT
cp LICENSE-MIT LICENSE-APACHE crates/python
python3 packaging/third_parties.py limitmesh-python > crates/python/LICENSE-THIRD-PARTY
for target; do
  # For systems since 2018: glibc 2.28, musl 1.2.
  case "$target" in
    *-linux-gnu) linked=(--zig --compatibility manylinux_2_28) ;;
    *-linux-musl) linked=(--zig --compatibility musllinux_1_2) ;;
    *) linked=() ;;
  esac
  maturin build --profile dist --locked --target "$target" ${linked[@]+"${linked[@]}"} --manifest-path crates/python/Cargo.toml \
    --out target/packages -- "$flags"
done
