#!/usr/bin/env bash
# Installs the Debian packages that furrow needs and this machine lacks, by apt, and checks that there is a Rust toolchain.
# Safe to run again.
# usage: scripts/packages.sh build    # what building needs: OpenCV, clang, a C++ compiler
#        scripts/packages.sh all      # that, and what the tests need: Chromium, Python, Slurm
set -euo pipefail

packages=(libopencv-dev clang libclang-dev pkg-config g++ make)
case ${1:-all} in
build) ;;
all) packages+=(chromium python3 python3-venv slurmctld slurmd slurm-client munge) ;;
*)
    printf 'packages: %s: expected build or all\n' "$1" >&2
    exit 2 ;;
esac

say() { printf 'packages: %s\n' "$*" >&2; }

missing=()
for package in "${packages[@]}"; do
    if ! dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'install ok installed'; then
        missing+=("$package")
    fi
done

if [ ${#missing[@]} -gt 0 ]; then
    if ! command -v apt-get >/dev/null; then
        say "this system has no apt. Please install, by its own package manager:"
        say "  OpenCV 4.5 or newer with headers, clang and libclang, pkg-config, a C++ compiler, make;"
        say "  for the tests also Chromium, Python 3 with venv, Slurm and munge."
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
