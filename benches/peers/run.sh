#!/bin/sh
# Sets up the peers in a virtual environment, builds skilltree, and compares them. Arguments go to compare.py.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
venv=${PEERS_VENV:-$root/target/peers-venv}
[ -x "$venv/bin/python" ] || "${PYTHON:-python3}" -m venv "$venv"
"$venv/bin/pip" install --quiet --requirement "$here/requirements.txt"
cargo build --release --manifest-path "$root/Cargo.toml"
export PYTHONDONTWRITEBYTECODE=1
exec "$venv/bin/python" "$here/compare.py" "${CARGO_TARGET_DIR:-$root/target}/release/skilltree" "$@"
