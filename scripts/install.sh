#!/usr/bin/env bash
# Installs what furrow needs and this machine lacks: Debian packages by apt, and a Rust toolchain check. Safe to run again.
set -euo pipefail

build_packages=(libopencv-dev clang libclang-dev pkg-config g++ make)
test_packages=(chromium python3 python3-venv slurmctld slurmd slurm-client munge)

say() { printf 'install: %s\n' "$*" >&2; }

missing=()
for package in "${build_packages[@]}" "${test_packages[@]}"; do
    if ! dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed'; then
        missing+=("$package")
    fi
done

if [ ${#missing[@]} -gt 0 ]; then
    if ! command -v apt-get >/dev/null; then
        say "this system has no apt. Please install, by its own package manager:"
        say "  OpenCV 4.5 or newer with headers, clang and libclang, pkg-config, a C++ compiler, make;"
        say "  for the tests also Chromium and Python 3 with venv."
        exit 1
    fi
    as_root=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || { say "not root, and no sudo: please have root install: ${missing[*]}"; exit 1; }
        as_root=(sudo)
    fi
    say "installing ${missing[*]}"
    "${as_root[@]}" apt-get update -qq
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
fi

if ! command -v cargo >/dev/null; then
    say "no cargo found: install Rust 1.95 or newer from https://rustup.rs and run this again"
    exit 1
fi
say "everything that furrow needs is here"
