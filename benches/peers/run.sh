#!/usr/bin/env bash
# Builds, runs every scene in every engine, and writes the peers' part of benches/report anew.
# Arguments go to driver.py: `./run.sh --only accuracy --scenes slide,stack`. NOBUILD=1: what is built is new enough.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
export PEERS=${PEERS:-$(cd "$here/../.." && pwd)/target/peers}
[ -n "${NOBUILD:-}" ] || "$here/build.sh"
python3 "$here/driver.py" "$@"
cd "$here/../.." && cargo bench --quiet --bench work_precision -- peers
