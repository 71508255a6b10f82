#!/usr/bin/env bash
# Publishes the crates whose version is not on crates.io yet, so that it can be run again after it was cut short.
set -euo pipefail
cd "$(dirname "$0")/.."
version="$(sed -n '/^\[workspace.package\]/,/^\[/s/^version = "\(.*\)"/\1/p' Cargo.toml)"

left=()
for manifest in crates/*/Cargo.toml; do
  grep -q '^publish = false' "$manifest" && continue
  crate="$(sed -n 's/^name = "\(.*\)"/\1/p' "$manifest" | head -n 1)"
  # Asked outside the workspace, where the name is that of the registry.
  if (cd / && cargo info --quiet --registry crates-io "$crate@$version" > /dev/null 2>&1); then
    echo "$crate $version is published"
  else
    left+=(--package "$crate")
  fi
done
if [ "${#left[@]}" -gt 0 ]; then
  cargo publish --locked "${left[@]}" "$@"
fi
