#!/usr/bin/env bash
# Builds all programs into $PEERS/bin (PEERS: default target/peers of the project): 10 to 20 minutes the first time.
# Needs cargo, a C compiler, and python3 with venv; pymunk is installed by its exact version.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
PEERS=${PEERS:-$(cd "$here/../.." && pwd)/target/peers}
mkdir -p "$PEERS/bin"

# build PACKAGE BINARY NAME [FEATURES]: each in a folder of its own, for features of one must not leak into another.
build() {
  (cd "$here" && CARGO_TARGET_DIR="$PEERS/$3" cargo build --quiet --release --locked --package "$1" ${4:+--features "$4"})
  cp -f "$PEERS/$3/release/$2" "$PEERS/bin/$3"
}
build peer-scenes dump_scenes scenes
build peer-ours peer-ours ours
build peer-box2d peer-box2d box2d avx2
build peer-box2d peer-box2d box2d-double double
build peer-rapier peer-rapier rapier det

rm -rf "$PEERS/scenes-json"
"$PEERS/bin/scenes" "$PEERS/scenes-json" >/dev/null
[ -x "$PEERS/venv/bin/python" ] || python3 -m venv "$PEERS/venv"
"$PEERS/venv/bin/python" -m pip install --quiet --disable-pip-version-check pymunk==7.3.1
