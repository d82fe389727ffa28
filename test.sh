#!/usr/bin/env bash
# Passes every check of the project: format, tests on the CPU and on software Vulkan, lints, docs.
# On Debian and Ubuntu it installs software Vulkan (mesa-vulkan-drivers) if there is no Vulkan driver yet.
set -euo pipefail
cd "$(dirname "$0")"

have_vulkan() {
    compgen -G '/usr/share/vulkan/icd.d/*.json' > /dev/null || compgen -G '/etc/vulkan/icd.d/*.json' > /dev/null \
        || [ -n "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ]
}

if ! have_vulkan; then
    as_root=()
    if [ "$(id -u)" -ne 0 ]; then as_root=(sudo); fi
    if ! command -v apt-get > /dev/null; then
        echo "no Vulkan driver found: install Mesa's software Vulkan (lavapipe) and run this again" >&2
        exit 1
    fi
    "${as_root[@]}" apt-get update
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y --no-install-recommends mesa-vulkan-drivers
fi

# Mesa complains on every start where there is no folder for sockets.
if [ -z "${XDG_RUNTIME_DIR:-}" ]; then
    XDG_RUNTIME_DIR=$(mktemp -d)
    export XDG_RUNTIME_DIR
    trap 'rm -rf "$XDG_RUNTIME_DIR"' EXIT
fi

cargo fmt --check
cargo test --release --locked
cargo clippy --release --locked --all-targets -- -D warnings
RUSTDOCFLAGS='-D warnings' cargo doc --release --locked --no-deps
