#!/usr/bin/env bash
# Sets up, builds and runs every test. Ends with CTest's summary and its exit code.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/setup.sh
cmake --preset release -DGLINT_WARNINGS_AS_ERRORS=ON
cmake --build --preset release
exec ctest --preset release -j2 --output-on-failure --no-tests=error
