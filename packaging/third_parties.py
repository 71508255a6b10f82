"""Writes the licences of the crates that a package of this workspace is made of: each text once, after the crates that have it.

    packaging/third_parties.py PACKAGE [FEATURES] > LICENSE-THIRD-PARTY
"""

import json
import subprocess
import sys
from collections import defaultdict
from pathlib import Path


def cargo(*words: str) -> str:
    return subprocess.run(["cargo", *words, "--locked"], check=True, capture_output=True, text=True, encoding="utf-8").stdout


package, features = sys.argv[1], sys.argv[2:]
tree = cargo("tree", "--package", package, "--features", ",".join(features), "--edges", "normal", "--target", "all", "--prefix", "none", "--format", "{p}")
built = {tuple(line.split()[:2]) for line in tree.splitlines() if line}
owners = defaultdict[str, list[str]](list)
for crate in json.loads(cargo("metadata", "--format-version", "1"))["packages"]:
    if (crate["name"], "v" + crate["version"]) not in built or not crate["source"]:
        continue
    folder = Path(crate["manifest_path"]).parent
    files = [file for file in sorted(folder.rglob("*")) if file.is_file() and file.name.upper().startswith(("LICENSE", "LICENCE", "COPYING", "NOTICE"))]
    texts = [file.read_text(encoding="utf-8", errors="replace").strip() for file in files]
    for text in texts or [f"{crate['license']}, by {', '.join(crate['authors']) or 'the authors of ' + crate['name']}; {crate['repository']}"]:
        owners[text].append(f"{crate['name']} {crate['version']} ({crate['license']})")

sys.stdout.reconfigure(encoding="utf-8")
print("limitmesh is made of its own code, under LICENSE-MIT or LICENSE-APACHE, and of the crates below.")
for text, crates in sorted(owners.items(), key=lambda entry: entry[1]):
    print("\n" + "=" * 80 + "\n" + "\n".join(dict.fromkeys(crates)) + "\n" + "-" * 80 + "\n" + text)
