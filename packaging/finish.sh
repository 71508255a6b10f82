#!/usr/bin/env bash
# Completes target/packages: the Blender extension; the sources, for Python and as they are here; recipes with version and sums; SHA256SUMS.
set -euo pipefail
cd "$(dirname "$0")/.."
field() { sed -n "/^\[workspace.package\]/,/^\[/s/^$1 = \"\(.*\)\"/\1/p" Cargo.toml; }
version="$(field version)"
packages=target/packages
sum() { sha256sum "$packages/limitmesh-$version$1.tar.gz" | cut -d ' ' -f 1; }

# Blender is built for glibc.
find "$packages" -name '*.whl' ! -name '*musllinux*' -exec python3 integrations/blender/build.py --out "$packages" {} +

git archive --format tar.gz --prefix "limitmesh-$version/" --output "$packages/limitmesh-$version-source.tar.gz" HEAD
# maturin takes along the licences that it finds there.
trap 'rm -f crates/python/LICENSE-*' EXIT
cp LICENSE-MIT LICENSE-APACHE crates/python
maturin sdist --manifest-path crates/python/Cargo.toml --out "$packages"

for recipe in limitmesh.rb recipe.yaml; do
  sed -e "s|@REPOSITORY@|$(field repository)|; s|@VERSION@|$version|g" \
    -e "s|@SOURCE_SHA256@|$(sum -source)|; s|@SDIST_SHA256@|$(sum "")|" "packaging/$recipe" > "$packages/$recipe"
done
cd "$packages"
rm -f SHA256SUMS
sha256sum -- * > ../SHA256SUMS
mv ../SHA256SUMS .
