#!/usr/bin/env bash
# Makes every picture of the book, with the program of this very tree: `bash book/pictures.sh`.
set -euo pipefail
cd "$(dirname "$0")/.."
cargo run --release --quiet -p phong-cli -- figure all -d book/src/figures
