#!/usr/bin/env bash
# Builds the program for targets and packs an archive of each: program, limitmesh-check, completions, pages of the manual, licences, README.
#
#   packaging/archives.sh TARGET...
#
# Writes to target/packages. The program of the first target must run here: it writes the completions and the manual.
set -euo pipefail
cd "$(dirname "$0")/.."
field() { sed -n "/^\[workspace.package\]/,/^\[/s/^$1 = \"\(.*\)\"/\1/p" Cargo.toml; }
version="$(field version)"
# No folder of this machine is named in the program.
export RUSTFLAGS="--remap-path-prefix=${CARGO_HOME:-$HOME/.cargo}=cargo"
# Where all crates are joined, little more is copied into its callers. Earlier it would take a seventh of the speed.
flags="-Cllvm-args=--inline-threshold=10 --inlinehint-threshold=25"

for target; do
  # The C library is that of systems since 2014 (glibc 2.17), or a part of the program (musl).
  case "$target" in
    *-linux-gnu) command=(cargo-zigbuild rustc --target "$target.2.17") ;;
    *-linux-musl) command=(cargo-zigbuild rustc --target "$target") ;;
    *) command=(cargo rustc --target "$target") ;;
  esac
  for program in cli:limitmesh check:limitmesh-check; do
    "${command[@]}" --profile dist --locked --package "limitmesh-${program%%:*}" --bin "${program#*:}" -- "$flags"
  done
done

# What all archives have.
common=target/packages/common
rm -rf "$common"
mkdir -p "$common/completions" "$common/man/man1"
cp CHANGELOG.md LICENSE-MIT LICENSE-APACHE "$common"
sed "s|@REPOSITORY@|$(field repository)|" packaging/program.md > "$common/README.md"
python3 packaging/third_parties.py limitmesh-cli > "$common/LICENSE-THIRD-PARTY"
program="target/$1/dist/limitmesh"
"$program" man "$common/man/man1"
for file in bash:limitmesh.bash zsh:_limitmesh fish:limitmesh.fish powershell:limitmesh.ps1 elvish:limitmesh.elv; do
  "$program" completions "${file%%:*}" > "$common/completions/${file#*:}"
done

for target; do
  name="limitmesh-$version-$target"
  folder="target/packages/$name"
  rm -rf "$folder"
  cp -r "$common" "$folder"
  case "$target" in
    *-windows-*) kind=zip suffix=.exe ;;
    *) kind=gztar suffix= ;;
  esac
  cp "target/$target/dist/limitmesh$suffix" "target/$target/dist/limitmesh-check$suffix" "$folder"
  python3 -c 'import shutil, sys; shutil.make_archive(*sys.argv[1:])' "$folder" "$kind" target/packages "$name"
  rm -rf "$folder"
done
rm -rf "$common"
