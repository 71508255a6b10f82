#!/usr/bin/env bash
# Tries the archive and the wheel of a target as a new user has them: without environment, and with NumPy alone.
#
#   packaging/try.sh TARGET
set -euo pipefail
cd "$(dirname "$0")/.."
packages="$PWD/target/packages"
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
cd "$folder"

python3 -c 'import shutil, sys; shutil.unpack_archive(sys.argv[1])' "$packages"/limitmesh-*-"$1".[tz]*
unpacked="$(echo limitmesh-*)"
env -i "$unpacked/limitmesh" refine builtin:cup -o cup.ply --picture cup.png --proof cup.proof
env -i "$unpacked/limitmesh" info cup.ply
env -i "$unpacked/limitmesh-check" cup.ply cup.proof

python3 -m venv environment
python="$(echo environment/[bS]*/python*)"
python="${python%% *}"
"$python" -m pip install --quiet numpy
"$python" -m pip install --quiet --no-index --find-links "$packages" --only-binary limitmesh limitmesh
"$python" -c 'import limitmesh; print(limitmesh.refine("builtin:cup"))'
